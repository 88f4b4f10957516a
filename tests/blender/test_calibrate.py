# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration in Blender, of emulated sensors that are turned on their limbs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from calibration_support import PHASES_S, follows_phases, guided
from connected import connected
from live_support import until
from support import (
    SITES,
    addon,
    error_of,
    evaluated_points,
    in_blenders_axes,
    library,
    no_such_file,
    reconstruct,
    settings,
)


@contextmanager
def _short_phases() -> Iterator[None]:
    calibrating = addon("session.calibrating")
    before = calibrating.PHASES
    calibrating.PHASES = tuple(
        replace(phase, seconds=seconds) for phase, seconds in zip(before, PHASES_S, strict=True)
    )
    try:
        yield
    finally:
        calibrating.PHASES = before


def _without_gyroscopes(take):
    sensors = {
        site: replace(record, angular_velocity=None, orientation=None)
        for site, record in take.sensors.items()
    }
    return replace(take, sensors=sensors)


def _first_axes(session):
    """(3, 3) rows: a specific force along each axis of the first sensor, as it is corrected."""
    if session._poses is None:
        return np.zeros((3, 3))
    corrected, _, _ = session._poses._reconstructor.sensors[0].corrected(np.eye(3))
    return corrected


def test_a_calibration_is_made_kept_and_used(tmp_path):
    performed = guided(tmp_path)
    doing = follows_phases(performed, addon("session.calibrating"), addon("session.job"))
    with _short_phases(), connected(tmp_path, doing) as session:
        assert bpy.ops.sparse_mocap.go_live() == {"FINISHED"}
        until(lambda: session.state.is_live)
        assert bpy.ops.sparse_mocap.calibrate_sensors() == {"FINISHED"}
        path = settings().calibration
        assert Path(path).parent == tmp_path / "takes"
        found = addon("session.calibrating").calibrations.get(path)
        for site, wanted in zip(SITES, performed.turns, strict=True):
            off = found.sensors[site].R_site_sensor @ wanted.T
            assert np.degrees(np.arccos(min((np.trace(off) - 1) / 2, 1.0))) < 5.0, site
        wanted = found.sensors[SITES[0]]
        until(lambda: np.allclose(_first_axes(session), wanted.scale * wanted.R_site_sensor.T))
        assert addon("scene.prompt")._handler is None


def test_a_take_is_reconstructed_as_the_calibration_says(tmp_path):
    """The same movements, as read by ideal sensors and by turned ones that are calibrated."""
    import sparse_mocap
    from sparse_mocap.calibration import Calibration, SensorCalibration, apply
    from sparse_mocap.calibration_file import write_calibration

    performed = guided(tmp_path)
    take = tmp_path / "accelerometers.csv"
    sparse_mocap.write_take(take, _without_gyroscopes(performed.take))
    found = {
        site: SensorCalibration(site, 1.03, R, 0.7, np.zeros(3), 1.0, True, True,
                                9.81, 0.0, 9.0, 0.1)
        for site, R in zip(SITES, performed.turns, strict=True)
    }  # fmt: skip
    write_calibration(tmp_path / "sensors.json", Calibration(found))
    ideal = apply(Calibration(found), sparse_mocap.read_take(take))
    chosen = settings()
    chosen.database, chosen.take = str(library().database), str(take)
    chosen.calibration = str(tmp_path / "sensors.json")
    bpy.context.scene.render.fps = 25
    armature = reconstruct()
    database = sparse_mocap.MotionDatabase(library().database)
    positions = dict.fromkeys(ideal.sites, 0.7)
    solved = sparse_mocap.reconstruct(ideal, database, positions_along_bone=positions)
    motion = solved.motion.without_extremities()
    wanted = in_blenders_axes(motion.joint_positions("world"))
    for index in (10, 200, 400):
        shown = evaluated_points(armature, index + 1, database.skeleton.names)
        assert np.abs(shown - wanted[index]).max() < 1e-3


def test_a_calibration_that_is_none_is_said_in_one_line(tmp_path):
    chosen = settings()
    chosen.database, chosen.take = str(library().database), str(library().take)
    (tmp_path / "bad.json").write_text("{}")
    for path, words in (("missing.json", no_such_file()), ("bad.json", "is not a calibration")):
        chosen.calibration = str(tmp_path / path)
        assert words in error_of(bpy.ops.sparse_mocap.reconstruct)
    assert not bpy.data.actions


def test_without_sensors_there_is_nothing_to_calibrate():
    assert "Connect" in error_of(bpy.ops.sparse_mocap.calibrate_sensors)


def test_what_to_do_stands_on_two_lines_where_one_is_too_short():
    halves = addon("scene.prompt")._halves
    text = "five times, thumbs forward, upper arms still"
    assert halves(text, 32.0, 1e6) == [text]
    assert halves(text, 32.0, 10.0) == ["five times, thumbs", "forward, upper arms still"]
    assert halves("word", 32.0, 1.0) == ["word"]
    assert halves("", 32.0, 1.0) == [""]
