# SPDX-License-Identifier: GPL-3.0-or-later
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sparse_mocap._core")
pytest.importorskip("serial")
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import sparse_mocap
from calibration_support import PHASES_S, follows_phases, guided
from live_support import DRIVER, OPTIONS, emulated, own_runtime, until
from sparse_mocap.calibration import CalibrationError
from sparse_mocap.calibration_file import read_calibration

from blender_addon.session import calibrating, live, sensors
from blender_addon.session import job as jobs
from blender_addon.session.errors import InputError
from blender_addon.session.job import Cancelled
from blender_addon.session.live_poses import LivePoses
from blender_addon.session.methods import MethodChoice

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]
PHASES = tuple(
    calibrating.Phase(phase.name, phase.text, seconds)
    for phase, seconds in zip(calibrating.PHASES, PHASES_S, strict=True)
)


@pytest.fixture(scope="module")
def performance(tmp_path_factory):
    pytest.importorskip("scipy", reason="the performance is made with SciPy")
    return guided(tmp_path_factory.mktemp("guided"))


@pytest.fixture(autouse=True)
def runtime(tmp_path):
    folder = tmp_path / "runtime"
    folder.mkdir(mode=0o700)
    with own_runtime(folder):
        yield
        live.end()


@contextmanager
def connected(doing, folder):
    """A session with an emulator of what the performer does."""
    with emulated(doing) as port:
        chosen = sensors.Port(port, DRIVER, options=OPTIONS, sites=", ".join(SITES))
        live.begin(sensors.new_session(chosen, folder))
        session = live.current()
        until(lambda: session.state.error or len(session.state.sensors) == len(SITES))
        yield session
        live.end()


@pytest.fixture
def session(performance, tmp_path):
    with connected(follows_phases(performance, calibrating, jobs), tmp_path / "takes") as session:
        yield session


def test_what_was_planted_is_found_and_kept(performance, session, tmp_path):
    told = []
    job = calibrating.calibrating_job(session, tmp_path / "takes", 1.75, PHASES)
    result = job.run(lambda: told.append((job.fraction, job.what)))
    sensors_found = result.calibration.sensors
    assert list(sensors_found) == SITES
    for site, R_site_sensor in zip(SITES, performance.turns, strict=True):
        off = sensors_found[site].R_site_sensor @ R_site_sensor.T
        assert np.degrees(np.arccos(min((np.trace(off) - 1) / 2, 1.0))) < 5.0, site
        assert sensors_found[site].scale == pytest.approx(1.03, rel=0.01)
    kept = read_calibration(result.path)
    assert (
        kept.sensors["left_ankle"].position_along_bone
        == sensors_found["left_ankle"].position_along_bone
    )
    assert Path(result.path).parent == tmp_path / "takes"
    assert calibrating.calibration_at(result.path).sensors.keys() == kept.sensors.keys()
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    for phase in PHASES:
        assert any(what.startswith(phase.text) for _, what in told)
    until(lambda: session.state.recording is None)


def test_cancelling_ends_the_recording_and_leaves_no_file(session, tmp_path):
    job = calibrating.calibrating_job(session, tmp_path / "takes", 1.75)
    threading.Timer(0.5, job.cancel).start()
    with pytest.raises(Cancelled):
        job.run()
    until(lambda: session.state.recording is None)
    assert list((tmp_path / "takes").glob("*.json")) == []


def test_who_fidgets_is_told_so_in_a_line(performance, tmp_path):
    """The performer bends the elbows when it is time to stand still."""
    (still,) = (phase for phase in PHASES if phase.name == "stand")
    folder = tmp_path / "takes"
    with connected(performance.parts["bend_elbows"], folder) as session:
        job = calibrating.calibrating_job(session, folder, 1.75, (still,))
        with pytest.raises(CalibrationError, match="still") as error:
            job.run()
    assert len(str(error.value).splitlines()) == 1
    assert list(folder.glob("*.json")) == []


def test_not_while_something_is_recorded(session, tmp_path):
    live.answer_of(session.record(), 5.0)
    until(lambda: session.state.recording is not None)
    with pytest.raises(InputError, match="stop it"):
        calibrating.calibrating_job(session, tmp_path, 1.75)


def test_live_poses_of_calibrated_sensors_are_those_of_ideal_ones(performance, tmp_path):
    """Whether the samples are corrected before or in the stream does not matter."""
    take, path = performance.take, tmp_path / "db.smdb"
    sparse_mocap.build_database([performance.body], path)
    database = sparse_mocap.MotionDatabase(path)
    found = {
        site: sparse_mocap.SensorCalibration(site, 1.03, R, 1.0, np.zeros(3), 1.0, True, True,
                                             9.81, 0.0, 9.0, 0.1)
        for site, R in zip(SITES, performance.turns, strict=True)
    }  # fmt: skip
    calibration = sparse_mocap.calibration.Calibration(found)
    ideal = sparse_mocap.calibration.apply(calibration, take)
    wanted, found = (
        sparse_mocap.reconstruct(one, database, calibration=how, use_gyroscopes=False)
        for one, how in ((ideal, None), (take, calibration))
    )
    assert np.abs(found.readings.specific_force - wanted.readings.specific_force).max() < 1e-9
    channels = [["specific_force"]] * len(SITES)
    poses = LivePoses(database, dict(enumerate(SITES)), channels, MethodChoice(), calibration)
    assert poses.advance(np.empty(0, sparse_mocap.capture.sample_log.SAMPLE)) is None
    with pytest.raises(CalibrationError, match="calibrate again"):
        LivePoses(database, {0: "chest"}, channels[:1], MethodChoice(), calibration)
