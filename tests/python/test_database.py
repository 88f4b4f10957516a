# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion databases through Python: their file, their arrays, their building."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from safetensors import safe_open
from safetensors.numpy import load_file
from sparse_mocap import (
    Cancelled,
    ConfigError,
    FormatError,
    MotionDatabase,
    build_database,
    read_motion,
    standard_motion,
)

ARRAYS = {
    "angles": 43,
    "positions": 63,
    "root_motion": 4,
    "contacts": 2,
    "specific_force_pivot": 42,
    "specific_force_end": 42,
    "angular_velocity": 42,
    "up": 42,
}


@pytest.mark.parametrize("name", ARRAYS)
def test_anyone_can_open_the_file(database: MotionDatabase, database_path: Path, name: str) -> None:
    public = load_file(database_path)
    array = database.array(name)
    assert array.shape == (database.num_frames, ARRAYS[name])
    assert array.dtype == np.float32
    lengths = [clip.end - clip.begin for clip in database.clips]

    def scaled(stored: str) -> np.ndarray:
        return public[stored] * np.repeat(public[f"{stored}/scale"], lengths, axis=0)

    if ARRAYS[name] == 42:
        expected = np.hstack([scaled(f"sites/{site}/{name}") for site in database.site_names])
    else:
        expected = public[name] if name in ("root_motion", "contacts") else scaled(name)
    np.testing.assert_array_equal(expected, array)


def test_numbers_are_kept_as_finely_as_they_fit(
    database: MotionDatabase, database_path: Path
) -> None:
    """In 16 bits, the scale being a power of two."""
    public = load_file(database_path)
    scales = [name for name in public if name.endswith("/scale")]
    assert len(scales) > 10
    for name in scales:
        values, mantissas = public[name.removesuffix("/scale")], np.frexp(public[name])[0]
        assert (mantissas == 0.5).all()
        for clip, scale in zip(database.clips, public[name][:, 0], strict=True):
            largest = int(np.abs(values[clip.begin : clip.end].astype(int)).max())
            assert largest >= 2**14 or scale <= 2.0**-20, name


def test_the_file_says_what_it_is(database_path: Path) -> None:
    with safe_open(database_path, "numpy") as file:
        metadata = file.metadata()
    assert metadata
    assert all(isinstance(value, str) for value in metadata.values())


def test_arrays_are_copies_that_nobody_writes_to(database_path: Path) -> None:
    opened = MotionDatabase(database_path)
    array = opened.array("positions")
    assert not array.flags.writeable
    first = array[0].copy()
    del opened
    np.testing.assert_array_equal(array[0], first)
    with pytest.raises(ValueError, match="read-only"):
        array[0, 0] = 1.0
    with pytest.raises(KeyError, match="nothing"):
        MotionDatabase(database_path).array("nothing")


def test_clips_cover_the_frames_in_order(database: MotionDatabase) -> None:
    clips = database.clips
    assert clips[0].begin == 0
    assert clips[-1].end == database.num_frames
    assert [clip.begin for clip in clips[1:]] == [clip.end for clip in clips[:-1]]
    assert json.loads(database.build_info)["mirror"] is True


def test_a_clip_is_its_file_on_the_standard_skeleton(
    database: MotionDatabase, library: Path
) -> None:
    positions = database.array("positions").reshape(-1, 21, 3)
    for clip in database.clips:
        if clip.is_mirrored or clip.tempo != 1.0:
            continue
        motion = standard_motion(read_motion(library / clip.source)[0], database.skeleton)[0]
        truth = motion.resampled(database.rate_hz).joint_positions("heading")
        np.testing.assert_allclose(positions[clip.begin : clip.end], truth, atol=1e-4)


def test_a_mirrored_clip_mirrors_positions_and_readings(database: MotionDatabase) -> None:
    names = database.skeleton.names
    other = [
        names.index({"l": "r", "r": "l"}[name[0]] + name[1:])
        if name[0] in "lr" and name not in ("root", "lowerback", "lowerneck")
        else index
        for index, name in enumerate(names)
    ]
    positions = database.array("positions").reshape(-1, 21, 3)
    force = database.array("specific_force_end").reshape(database.num_frames, -1, 3)
    for clip in database.clips:
        if not clip.is_mirrored:
            continue
        (origin,) = (
            one
            for one in database.clips
            if (one.source, one.tempo, one.is_mirrored) == (clip.source, clip.tempo, False)
        )
        now, before = slice(clip.begin, clip.end), slice(origin.begin, origin.end)
        np.testing.assert_allclose(
            positions[now], positions[before][:, other] * [-1, 1, 1], atol=2e-4
        )
        wrists = force[before][:, [1, 0, 3, 2]] * [1, -1, 1]
        np.testing.assert_allclose(force[now][:, :4], wrists, atol=1e-2)


def test_a_build_can_be_stopped_and_leaves_nothing(library: Path, tmp_path: Path) -> None:
    calls: list[tuple[int, int, str]] = []

    def stop_at_five(done: int, total: int, what: str) -> bool:
        calls.append((done, total, what))
        return len(calls) < 5

    with pytest.raises(Cancelled):
        build_database([library], tmp_path / "db.smdb", progress=stop_at_five)
    assert len(calls) == 5
    assert calls[0][1] == 24
    assert calls[0][2].endswith(".bvh")
    assert list(tmp_path.iterdir()) == []


def test_what_a_progress_callback_raises_comes_out(library: Path, tmp_path: Path) -> None:
    def fail(*_: object) -> None:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        build_database([library], tmp_path / "db.smdb", progress=fail)
    assert list(tmp_path.iterdir()) == []


def test_a_build_reports_what_it_did(library: Path, tmp_path: Path) -> None:
    (tmp_path / "broken.bvh").write_text("HIERARCHY", encoding="utf-8")
    report = build_database([library, tmp_path], tmp_path / "db.smdb", reverse=True)
    assert (report.num_files, report.num_clips) == (12, 72)
    assert report.num_frames == MotionDatabase(tmp_path / "db.smdb").num_frames
    ((path, reason),) = report.skipped
    assert path == str(tmp_path / "broken.bvh")
    assert reason.startswith(path)


@pytest.mark.parametrize("rate", [0, -25, float("nan"), float("inf"), 1e9])
def test_an_impossible_rate_is_refused(library: Path, tmp_path: Path, rate: float) -> None:
    with pytest.raises(ConfigError, match="rate"):
        build_database([library], tmp_path / "db.smdb", rate_hz=rate)


def test_no_source_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"holds no motion file"):
        build_database([], tmp_path / "db.smdb")
    with pytest.raises(FormatError, match=r"holds no motion file") as caught:
        build_database([tmp_path], tmp_path / "db.smdb")
    assert caught.value.path == str(tmp_path)


DAMAGE = {
    "empty": lambda data: b"",
    "seven bytes": lambda data: data[:7],
    "not at all": lambda data: b"PK\x03\x04" + data[4:],
    "as text": lambda data: data.replace(b"\n", b"\r\n") + b"\r\n",
    "cut": lambda data: data[: len(data) // 2],
    "too long": lambda data: data + b"\0",
    "flipped": lambda data: data[:-100] + bytes([data[-100] ^ 1]) + data[-99:],
    "huge header": lambda data: b"\xff" * 8 + data[8:],
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_database_is_refused(database_path: Path, tmp_path: Path, name: str) -> None:
    path = tmp_path / "damaged.smdb"
    path.write_bytes(DAMAGE[name](database_path.read_bytes()))
    with pytest.raises(FormatError, match="not a sound motion database") as caught:
        MotionDatabase(path)
    assert str(caught.value).startswith(str(path))
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="no open file is replaced on Windows")
def test_an_open_database_outlives_its_file(database_path: Path, tmp_path: Path) -> None:
    path = tmp_path / "db.smdb"
    path.write_bytes(database_path.read_bytes())
    opened = MotionDatabase(path)
    before = np.array(opened.array("positions"))
    other = tmp_path / "other.smdb"
    other.write_bytes(database_path.read_bytes())
    other.replace(path)
    path.unlink()
    np.testing.assert_array_equal(opened.array("positions"), before)
