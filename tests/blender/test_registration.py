# SPDX-License-Identifier: GPL-3.0-or-later
import threading

import bpy
import installed
from support import (
    Skipped,
    addon,
    choose_files,
    error_of,
    is_registered,
    library,
    loaded_modules,
    settings,
)


def _ours() -> list[str]:
    kinds = (bpy.types.Operator, bpy.types.Panel, bpy.types.PropertyGroup)
    return [
        cls.__name__
        for kind in kinds
        for cls in kind.__subclasses__()
        if "SPARSEMOCAP" in cls.__name__.upper() and cls.is_registered
    ]


def _handlers() -> int:
    return sum(
        len(value)
        for name in dir(bpy.app.handlers)
        if type(value := getattr(bpy.app.handlers, name)) is list
    )


def test_twenty_times_leaves_nothing():
    installed.unregister()
    before = (_handlers(), threading.active_count(), set(dir(bpy.types.Scene)))
    for _ in range(20):
        installed.register()
        assert is_registered()
        assert len(_ours()) >= 8
        installed.unregister()
        assert _ours() == []
        assert (_handlers(), threading.active_count(), set(dir(bpy.types.Scene))) == before
        assert loaded_modules() == set()


def test_reloaded_scripts_register_it_once():
    """Blender's own Reload Scripts; the sources are not enabled, so it leaves them alone."""
    if not bpy.app.binary_path:
        raise Skipped("a bpy module does not reload scripts")
    handlers, before = _handlers(), sorted(_ours())
    for _ in range(2):
        assert bpy.ops.script.reload() == {"FINISHED"}
        assert is_registered()
        assert _handlers() == handlers
        assert sorted(_ours()) == before
    choose_files()
    assert bpy.ops.sparse_mocap.reconstruct(offline=False) == {"FINISHED"}


def test_unregister_ends_the_job_at_work(tmp_path):
    output = tmp_path / "never.smdb"
    steps = addon("session.database")
    job, _ = steps.build_job([str(library().motions)], str(output), steps.BuildChoices(mirror=True))
    job.start()
    installed.unregister()
    assert not job.is_running
    assert list(tmp_path.iterdir()) in ([], [output])  # done already, or nothing of it


def test_settings_have_defaults_in_every_scene():
    other = bpy.data.scenes.new("other")
    assert other.sparse_mocap.method == settings().method == "path_regression"
    assert other.sparse_mocap.preset == settings().preset == "default"
    assert other.sparse_mocap.mirror
    assert other.sparse_mocap.offline


def test_a_missing_core_is_said_in_one_line():
    core = addon("session.core")
    core._found.cache_clear()
    modules, core.MODULES = core.MODULES, ("sparse_mocap.not_there",)
    try:
        reason = core.missing_reason()
        assert "install" in reason
        assert "\n" not in reason
        source = str(library().motions)
        line = error_of(lambda: bpy.ops.sparse_mocap.build_database(source=source))
        assert line == reason
    finally:
        core.MODULES = modules
        core._found.cache_clear()
