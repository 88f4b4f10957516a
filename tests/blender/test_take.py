# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
from support import SITES, addon, error_of, library, settings


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
    assert "No such file" in loaded(tmp_path / "missing.csv")
    assert "Choose a take" in loaded("")
    assert settings().take == ""
