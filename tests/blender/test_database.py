# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
from support import addon, error_of, library, no_such_file, raised, settings


def test_builds_and_is_chosen(tmp_path):
    output = tmp_path / "built.smdb"
    done = bpy.ops.sparse_mocap.build_database(
        source=str(library().motions), filepath=str(output), mirror=True
    )
    assert done == {"FINISHED"}
    assert [path.name for path in tmp_path.iterdir()] == ["built.smdb"]
    assert settings().database == str(output)
    database = addon("session.database").databases.get(str(output))
    assert database.num_sources == library().num_files
    mirrored = [clip.is_mirrored for clip in database.motions.clips]
    assert 2 * sum(mirrored) == len(mirrored) == database.num_clips
    assert database.rate_hz == 25.0
    assert database.size_bytes == output.stat().st_size
    assert 0.01 < database.minutes < 10.0


def test_what_is_not_given_comes_from_the_panel(tmp_path):
    settings().source = str(library().motions)
    settings().output = str(tmp_path / "panel")
    settings().mirror = False
    settings().exclude = "*walk*, nothing"
    bpy.ops.sparse_mocap.build_database()
    database = addon("session.database").databases.get(str(tmp_path / "panel.smdb"))
    names = [path.stem for path in library().motions.iterdir() if "walk" not in path.stem]
    assert database.num_sources == len(names)
    assert not any(clip.is_mirrored for clip in database.motions.clips)


def test_cancel_leaves_no_file(tmp_path):
    output = tmp_path / "cancelled.smdb"
    steps = addon("session.database")
    job, _ = steps.build_job([str(library().motions)], str(output), steps.BuildChoices(mirror=True))
    raised(addon("session.job").Cancelled, lambda: job.run(job.cancel))
    assert list(tmp_path.iterdir()) == []


def test_open_chooses_a_database():
    bpy.ops.sparse_mocap.open_database(filepath=str(library().database))
    assert settings().database == str(library().database)


def test_bad_sources_give_one_line(tmp_path):
    def build(source, output="x.smdb"):
        return error_of(
            lambda: bpy.ops.sparse_mocap.build_database(
                source=str(source), filepath=str(tmp_path / output)
            )
        )

    assert "folder" in build("")
    assert "nowhere" in build(tmp_path / "nowhere")
    empty = tmp_path / "empty"
    empty.mkdir()
    assert str(empty) in build(empty)
    assert "empty" in build(library().motions, output="empty/missing/x.smdb")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["empty"]


def test_bad_databases_give_one_line(tmp_path):
    def opened(path):
        return error_of(lambda: bpy.ops.sparse_mocap.open_database(filepath=str(path)))

    data = library().database.read_bytes()
    damaged = tmp_path / "damaged.smdb"
    for bad in (b"", data[:100], data[:-1], data[:-200] + bytes(100) + data[-100:]):
        damaged.write_bytes(bad)
        assert "damaged.smdb" in opened(damaged)
    assert no_such_file() in opened(tmp_path / "missing.smdb")
    assert "folder" in opened(tmp_path)
    assert "Choose a motion database" in opened("")


def test_several_sources_and_all_options_come_from_the_panel(tmp_path):
    files = sorted(library().motions.iterdir())
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\n")
    names = [{"name": files[0].name}, {"name": files[1].name}]
    bpy.ops.sparse_mocap.add_sources(directory=str(library().motions), files=names)
    bpy.ops.sparse_mocap.add_sources(directory=str(tmp_path), dirs=[{"name": "."}])
    bpy.ops.sparse_mocap.add_sources(directory=str(tmp_path), files=[{"name": "gone.bvh"}])
    assert settings().source == str(files[0])
    paths = [item.path for item in settings().more_sources]
    assert paths == [str(files[1]), str(tmp_path), str(tmp_path / "gone.bvh")]
    bpy.ops.sparse_mocap.remove_source(index=2)
    settings().output = str(tmp_path / "panel")
    settings().rate_hz, settings().reverse, settings().tempos = 30.0, True, False
    settings().mirror = False
    bpy.ops.sparse_mocap.build_database()
    database = addon("session.database").databases.get(str(tmp_path / "panel.smdb"))
    assert (database.num_sources, database.rate_hz) == (2, 30.0)
    assert {clip.tempo for clip in database.motions.clips} == {1.0}
    assert any(clip.is_reversed for clip in database.motions.clips)
    assert bpy.ops.sparse_mocap.show_build_report() == {"FINISHED"}
    report = bpy.data.texts["Motion Database Report"].as_string()
    assert str(bad) in report
    assert "Skipped: 1" in report
    settings().strict = True
    assert "bad.bvh" in error_of(bpy.ops.sparse_mocap.build_database)
