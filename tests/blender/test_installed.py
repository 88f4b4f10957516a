# SPDX-License-Identifier: GPL-3.0-or-later
"""The release file itself: installed, used, upgraded and removed by Blender's own means."""

import os
import re
import sys
import zipfile
from pathlib import Path

import installed
from support import Skipped, addon, choose_files, is_registered, loaded_modules, reconstruct


def _files() -> list[str]:
    """What of the add-on and its packages is in Blender's user folder."""
    folder = Path(os.environ["BLENDER_USER_RESOURCES"])
    return sorted(
        str(path.relative_to(folder))
        for path in folder.rglob("*")
        if path.is_file() and re.search(r"sparse_mocap|serial", str(path.relative_to(folder)))
    )


def _released(files: list[str]) -> list[str]:
    """Those of a release: no compiled modules, and no log, which people may still want to send."""
    return [name for name in files if not name.endswith((".pyc", ".log"))]


def _needs_package() -> None:
    if not installed.PACKAGE:
        raise Skipped("no release file is tested: SPARSE_MOCAP_PACKAGE names one")


def _older(folder: Path) -> Path:
    """The release file with an older version's number in it."""
    path = folder / Path(installed.PACKAGE).name
    with zipfile.ZipFile(installed.PACKAGE) as new, zipfile.ZipFile(path, "w") as old:
        for name in new.namelist():
            data = new.read(name)
            if name == "blender_manifest.toml":
                data = re.sub(rb'(?m)^version = ".*"', b'version = "0.0.1"', data)
            elif name == f"{installed.ADDON}/__init__.py":
                data = re.sub(rb'"version": \(.*?\)', b'"version": (0, 0, 1)', data)
            old.writestr(name, data)
    return path


def _version() -> str:
    folder = Path(installed.module().__file__).parent
    return addon("session.installation_paths").addon_version(folder)


def test_installed_and_removed_twenty_times_leaves_nothing():
    _needs_package()
    try:
        for _ in range(20):
            installed.remove()
            assert not is_registered()
            assert loaded_modules() == set()
            assert _released(_files()) == []
            installed.install()
            installed.register()
            assert is_registered()
            assert installed.module("session.core").missing_reason() == ""
    finally:
        installed.install()


def test_works_without_the_sources():
    _needs_package()
    choose_files()
    reconstruct()
    where = Path(sys.modules["sparse_mocap"].__file__)
    assert installed.ROOT not in where.parents
    assert installed.ROOT not in Path(installed.module().__file__).parents
    assert Path(os.environ["BLENDER_USER_RESOURCES"]) in where.parents


def test_nothing_is_written_into_its_own_folder():
    _needs_package()
    choose_files()
    reconstruct()
    folder = Path(installed.module().__file__).parent
    found = {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.suffix != ".pyc"  # Python puts these beside each module
    }
    with zipfile.ZipFile(installed.PACKAGE) as archive:
        released = {
            name.removeprefix(f"{installed.ADDON}/"): archive.read(name)
            for name in archive.namelist()
            if not name.endswith("/")
        }
    names = sorted(found.keys() | released.keys())
    assert [name for name in names if found.get(name) != released.get(name)] == []


def test_an_upgrade_replaces_all_files(tmp_path):
    _needs_package()
    files = _files()
    installed.remove()
    try:
        installed.install(_older(tmp_path))
        installed.register()
        assert _released(_files()) == _released(files)
        installed.unregister()
    finally:
        installed.install()
    installed.register()
    assert _version() not in ("", "0.0.1")
