# SPDX-License-Identifier: GPL-3.0-or-later
"""Teaching the motion database a movement of the performer's own."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from unittest.mock import MagicMock

import bpy
from support import SITES, addon, choose_files, error_of, library, reconstruct, settings


@cache
def _lesson() -> tuple[Path, Path, Path]:
    """A motion, the take to it, and the take of another movement."""
    import sparse_mocap

    folder = library().database.parent
    paths = [folder / "all" / name for name in ("ada_kickleft_01.bvh", "ada_squat_01.bvh")]
    takes = []
    for path in paths:
        standard, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(path)[0])
        takes.append(folder / f"{path.stem}.csv")
        sparse_mocap.write_take(takes[-1], sparse_mocap.simulated(standard, SITES, 100.0))
    return paths[0], takes[0], takes[1]


def _choose(take: Path) -> None:
    choose_files()
    assert bpy.ops.sparse_mocap.choose_taught_motion(filepath=str(_lesson()[0])) == {"FINISHED"}
    assert bpy.ops.sparse_mocap.choose_taught_take(filepath=str(take)) == {"FINISHED"}


def test_a_motion_and_its_take_are_in_the_new_database():
    import sparse_mocap

    _choose(_lesson()[1])
    before = library().database.read_bytes()
    assert bpy.ops.sparse_mocap.teach() == {"FINISHED"}
    path = Path(settings().database)
    assert path != library().database
    assert path.parent == library().database.parent
    assert library().database.read_bytes() == before
    taught = [clip for clip in sparse_mocap.MotionDatabase(path).clips if clip.take is not None]
    assert {clip.source for clip in taught} == {"ada_kickleft_01.bvh"}
    assert taught[0].take.name == "ada_kickleft_01.csv"
    (summary,) = addon("session.teaching").last_taught
    assert summary.path == str(path)
    assert summary.quality == "very good"
    assert abs(summary.begin_s) < 0.01
    reconstruct()


def test_each_lesson_is_a_file_of_its_own(tmp_path):
    output_for = addon("session.teaching").output_for
    first = Path(output_for(str(tmp_path / "walks.smdb")))
    assert first.name == "walks taught.smdb"
    first.touch()
    assert Path(output_for(str(first))).name == "walks taught-2.smdb"


def test_wrong_choices_change_nothing():
    assert error_of(bpy.ops.sparse_mocap.teach) == "Choose a motion database first"
    choose_files()
    missing = "Choose the motion file that was performed first"
    assert error_of(bpy.ops.sparse_mocap.teach) == missing
    _choose(_lesson()[2])
    said = error_of(bpy.ops.sparse_mocap.teach)
    assert said.startswith("ada_squat_01.csv does not fit ada_kickleft_01.bvh")
    teaching = settings().teaching
    teaching.has_clap, teaching.clap_from_s, teaching.clap_to_s = True, 2.0, 1.0
    assert error_of(bpy.ops.sparse_mocap.teach) == (
        "The clap must end after it begins: change its times"
    )
    assert settings().database == str(library().database)


def _shown() -> str:
    """All labels, values and buttons that the box draws."""
    layout = MagicMock()
    for part in ("row", "column", "box", "split"):
        getattr(layout, part).return_value = layout
    addon("ui.teaching").draw_teaching(layout, bpy.context)
    calls = (layout.label.call_args_list, layout.operator.call_args_list)
    labels = [call.kwargs.get("text", "") for call in calls[0]]
    return " ".join([*labels, *(call.args[0] for call in calls[1])])


def test_the_panel_says_how_well_both_match():
    _choose(_lesson()[1])
    assert "sparse_mocap.teach" not in _shown()
    settings().teaching.is_open = True
    assert "sparse_mocap.teach" in _shown()
    assert "very good" not in _shown()
    assert bpy.ops.sparse_mocap.teach() == {"FINISHED"}
    assert "very good" in _shown()


def test_cancelling_writes_nothing(tmp_path):
    teaching = addon("session.teaching")
    lesson = teaching.Lesson(str(_lesson()[0]), str(_lesson()[1]))
    job = teaching.teach_job(str(library().database), lesson, str(tmp_path / "out.smdb"))
    job.cancel()
    try:
        job.run()
        raise AssertionError("it was not cancelled")
    except addon("session.job").Cancelled:
        pass
    assert list(tmp_path.iterdir()) == []
