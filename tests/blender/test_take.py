# SPDX-License-Identifier: GPL-3.0-or-later
import os
import shutil

import bpy
from support import SITES, addon, error_of, library, no_such_file, settings, undo


def test_load_tells_what_is_in_it():
    assert bpy.ops.sparse_mocap.load_take(filepath=str(library().take)) == {"FINISHED"}
    assert settings().take == str(library().take)
    take = addon("session.take").takes.get(settings().take)
    assert take.name == "first_walk"
    assert take.sensors == SITES
    assert abs(take.rate_hz - 100.0) < 0.1
    assert 1.0 < take.duration_s < 60.0


def test_bad_takes_give_one_line(tmp_path):
    def loaded(path):
        return error_of(lambda: bpy.ops.sparse_mocap.load_take(filepath=str(path)))

    bad = tmp_path / "bad.csv"
    header = "time_s,sensor,ax,ay,az\n"
    bad.write_text(header + "0,left_tentacle,0,0,9.81\n0.01,left_tentacle,0,0,9.81\n")
    assert "left_tentacle" in loaded(bad)
    bad.write_text(header)
    assert "bad.csv" in loaded(bad)
    bad.write_text(header + "0,left_wrist,a,b\n")
    assert "bad.csv:2" in loaded(bad)
    bad.write_bytes(b"\xff\xfe\0\0")
    assert "bad.csv" in loaded(bad)
    assert no_such_file() in loaded(tmp_path / "missing.csv")
    assert "Choose a take" in loaded("")
    assert settings().take == ""


def _copied(folder, *names):
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        shutil.copy(library().take, folder / name)


def test_takes_are_listed_with_paths_beside_the_file(tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    _copied(tmp_path / "takes", "a.csv", "b.csv")
    (tmp_path / "takes" / "notes.csv").write_text("no take")
    assert bpy.ops.sparse_mocap.find_takes() == {"FINISHED"}
    rows = settings().takes
    assert sorted(row.name for row in rows) == ["a", "b"]
    paths = {row.path.replace(os.sep, "/") for row in rows}  # Blender's are as the system's
    assert paths == {"//takes/a.csv", "//takes/b.csv"}
    assert all(row.num_sensors == 4 and row.duration_s > 1.0 for row in rows)
    bpy.ops.sparse_mocap.find_takes()
    assert len(rows) == 2
    settings().take_index = 0
    assert settings().take == rows[0].path


def test_a_missing_take_is_found_again(tmp_path):
    _copied(tmp_path / "old", "a.csv")
    bpy.ops.sparse_mocap.load_take(filepath=str(tmp_path / "old" / "a.csv"))
    (tmp_path / "old").rename(tmp_path / "new")
    takes = addon("scene.takes")
    [row] = settings().takes
    assert takes.is_missing(row)
    bpy.ops.sparse_mocap.find_takes(directory=str(tmp_path / "new"))
    assert len(settings().takes) == 1
    assert not takes.is_missing(row)


def test_removing_or_undoing_never_removes_a_file(tmp_path):
    _copied(tmp_path, "a.csv")
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.sparse_mocap.load_take("EXEC_DEFAULT", True, filepath=str(tmp_path / "a.csv"))
    undo()
    assert len(settings().takes) == 0
    assert (tmp_path / "a.csv").exists()
    bpy.ops.sparse_mocap.load_take(filepath=str(tmp_path / "a.csv"))
    assert bpy.ops.sparse_mocap.remove_take() == {"FINISHED"}
    assert (len(settings().takes), settings().take) == (0, "")
    assert (tmp_path / "a.csv").exists()


def test_what_belongs_to_the_person_survives_another_file(tmp_path):
    chosen = settings()
    chosen.database, chosen.calibration = str(library().database), str(tmp_path / "c.json")
    chosen.port, chosen.driver, chosen.height_m = "/dev/ttyUSB7", "ximu3", 1.6
    chosen.take = str(library().take)
    other = bpy.data.scenes.new("other")
    assert other.sparse_mocap.database == str(library().database)
    bpy.ops.wm.read_homefile(use_empty=True)
    fresh = settings()
    assert fresh.database == str(library().database)
    assert fresh.calibration == str(tmp_path / "c.json")
    assert (fresh.port, fresh.driver) == ("/dev/ttyUSB7", "ximu3")
    assert abs(fresh.height_m - 1.6) < 1e-6
    assert fresh.take == ""
