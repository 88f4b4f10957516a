# SPDX-License-Identifier: GPL-3.0-or-later
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sparse_mocap._core")
pytest.importorskip("serial")
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import sparse_mocap
import sparse_mocap.pose_calibration
from calibration_support import HOLD_S, READY_S, follows_poses, held
from calibration_support import TRACKER_SITES as SITES
from live_support import emulated, own_runtime, until
from sparse_mocap.calibration_file import read_calibration

from blender_addon.session import live, pose_guide, sensors
from blender_addon.session.errors import InputError
from blender_addon.session.job import Cancelled

TIMES = pose_guide.Times(READY_S, HOLD_S)


@pytest.fixture(scope="module")
def performance():
    return held()


@pytest.fixture
def session(performance, tmp_path):
    folder = tmp_path / "runtime"
    folder.mkdir(mode=0o700)
    doing = follows_poses(performance, pose_guide)
    with own_runtime(folder), emulated(doing, {"output": "mtdata2"}) as port:
        chosen = sensors.Port(port, "xsens_mt", options="output=mtdata2", sites=", ".join(SITES))
        live.begin(sensors.new_session(chosen, tmp_path / "takes"))
        session = live.current()
        until(lambda: session.state.error or len(session.state.sensors) == len(SITES))
        yield session
        live.end()


def angle_deg(R):
    return np.degrees(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1)))


def test_the_performer_sees_the_left_at_the_left_as_in_a_mirror():
    points, _ = pose_guide.points_of("left_knee_up")
    joints = list(sparse_mocap.body_of_height(1.75).skeleton.names)
    left, right = joints.index("ltibia"), joints.index("rtibia")
    mirrored = pose_guide.views_of(points)[pose_guide.MIRRORED]
    assert mirrored[left, 0] < mirrored[right, 0]
    assert mirrored[left, 1] > mirrored[right, 1] + 0.3
    side = pose_guide.views_of(points)[pose_guide.FROM_RIGHT]
    assert side[left, 0] > side[right, 0] + 0.3  # who looks from the right sees it go right
    assert side[left, 1] == mirrored[left, 1]


def test_what_is_wrong_is_said_with_the_names_that_are_shown():
    said = "left_hand turned by 32 degrees during arms_out; hold the pose still"
    wanted = 'Left Hand turned by 32 degrees during "Arms out to the sides"; hold the pose still'
    assert pose_guide.with_shown_names(said) == wanted


def test_a_pose_is_held_for_its_full_time_after_a_long_calculation():
    guide = pose_guide._Guide(TIMES, lambda *_: True, 8)
    guide._end_s -= 60.0
    begin_s = time.perf_counter()
    guide.wait(pose_guide.Shown("arms_out", is_held=True), 0.2)
    assert time.perf_counter() - begin_s >= 0.2


def test_the_guide_finds_how_trackers_sit(performance, session, tmp_path):
    shown = []
    job = pose_guide.pose_guide_job(session, tmp_path / "takes", TIMES)
    result = job.run(lambda: shown.append((job.fraction, job.what, pose_guide.shown)))
    for site, R_site_sensor in zip(SITES, performance.turns, strict=True):
        off = angle_deg(result.calibration.sensors[site].R_site_sensor @ R_site_sensor.T)
        assert off < 10.0, site
    assert set(read_calibration(result.path).sensors) == set(SITES)
    assert any("no bone was measured" in note for note in result.notes)
    poses = [name for name, _, _ in sparse_mocap.pose_calibration.calibration_poses()]
    assert list(dict.fromkeys(now.pose for _, _, now in shown)) == poses
    assert {what for _, what, _ in shown} == {pose_guide.POSE_TEXTS[pose] for pose in poses}
    fractions = [fraction for fraction, _, _ in shown]
    assert fractions == sorted(fractions)
    told = [now.missed_deg for _, _, now in shown if now.pose == "lean_left" and not now.is_held]
    assert told
    assert all(0.0 <= missed < 20.0 for missed in told)
    assert pose_guide.shown.pose == ""
    until(lambda: session.state.recording is None)


def test_cancelling_ends_the_recording_and_leaves_no_file(session, tmp_path):
    job = pose_guide.pose_guide_job(session, tmp_path / "takes", TIMES)
    threading.Timer(1.6, job.cancel).start()
    with pytest.raises(Cancelled):
        job.run()
    until(lambda: session.state.recording is None)
    assert list((tmp_path / "takes").glob("*.json")) == []


def test_not_while_something_is_recorded(session, tmp_path):
    live.answer_of(session.record(), 5.0)
    until(lambda: session.state.recording is not None)
    with pytest.raises(InputError, match="stop it"):
        pose_guide.pose_guide_job(session, tmp_path)


def test_every_pose_has_its_text_and_its_points():
    poses = [name for name, _, _ in sparse_mocap.pose_calibration.calibration_poses()]
    assert list(pose_guide.POSE_TEXTS) == poses
    points, parents = pose_guide.points_of("arms_up")
    names = list(sparse_mocap.standard_joint_names())
    assert points.shape == (21, 3)
    assert len(parents) == 21
    assert points[names.index("lwrist"), 1] > points[names.index("head"), 1]
