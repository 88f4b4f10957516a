# SPDX-License-Identifier: GPL-3.0-or-later
"""The three steps without Blender, on the compiled core."""

import numpy as np
import pytest
import sparse_mocap
from sparse_mocap.demo_motions import generate_performance

from blender_addon.session import database, reconstruct, take
from blender_addon.session.errors import InputError
from blender_addon.session.job import Cancelled
from blender_addon.session.methods import MethodChoice, choice_of, method_items, option_items

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


@pytest.fixture(scope="module")
def motions(tmp_path_factory):
    folder = tmp_path_factory.mktemp("motions")
    generate_performance(folder / "all.bvh")
    return folder


@pytest.fixture(scope="module")
def files(motions):
    """A database and a take of a part of it."""
    built, recorded = motions.parent / "all.smdb", motions.parent / "part.csv"
    job, target = database.build_job([str(motions)], str(built), database.BuildChoices())
    job.run()
    assert target == str(built)
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(motions / "all.bvh")[0])
    sparse_mocap.write_take(recorded, sparse_mocap.simulated(motion.trimmed(0, 300), SITES, 100.0))
    return str(built), str(recorded)


def test_output_is_beside_the_folder_and_gets_its_ending(tmp_path):
    assert database.default_output(str(tmp_path / "walks")) == str(tmp_path / "walks.smdb")
    assert database.default_output(str(tmp_path / "walks") + "/") == str(tmp_path / "walks.smdb")
    assert database.checked_output(str(tmp_path / "x.y")) == str(tmp_path / "x.y.smdb")


def test_sources_that_are_none_are_refused(tmp_path):
    for source, said in (("", "folder with motion files"), (str(tmp_path / "nowhere"), "nowhere")):
        with pytest.raises(InputError, match=said):
            database.build_job([source], str(tmp_path / "x"), database.BuildChoices())


def test_patterns_leave_files_out(motions, tmp_path):
    job, _ = database.build_job(
        [str(motions)], str(tmp_path / "x"), database.BuildChoices(exclude=" , *.bvh,")
    )
    with pytest.raises(ValueError, match="excluded"):
        job.run()
    assert list(tmp_path.iterdir()) == []


def test_a_build_says_what_it_left_out(motions, tmp_path):
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nnothing\n")
    sources = [str(motions), str(bad), str(motions)]
    choices = database.BuildChoices(rate_hz=30.0, reverse=True, tempos=False)
    job, target = database.build_job(sources, str(tmp_path / "x"), choices)
    summary = job.run()
    assert database.last_build == [summary]
    assert [path for path, _ in summary.skipped] == [str(bad)]
    assert "bad.bvh" in summary.text()
    opened = database.open_database(target)
    assert opened.rate_hz == 30.0
    assert {(clip.is_reversed, clip.tempo) for clip in opened.motions.clips} == {
        (False, 1.0),
        (True, 1.0),
    }
    strict = database.BuildChoices(strict=True)
    with pytest.raises(ValueError, match=r"bad\.bvh"):
        database.build_job(sources, str(tmp_path / "y"), strict)[0].run()
    assert not (tmp_path / "y.smdb").exists()


def test_database_and_take_say_what_is_in_them(files):
    opened, loaded = database.databases.get(files[0]), take.takes.get(files[1])
    assert (opened.num_sources, opened.rate_hz) == (1, 25.0)
    assert opened.num_clips >= 1
    assert loaded.sensors == SITES
    assert loaded.rate_hz == pytest.approx(100.0)
    assert loaded.duration_s == pytest.approx(5.0, abs=0.05)


@pytest.mark.parametrize("method", ["", "path_regression", "tautges2011", "liu2011"])
def test_reconstruct_gives_the_take_a_motion(files, method):
    choice = MethodChoice(method)
    performance = reconstruct.reconstruct_job(*files, choice=choice, best_quality=False).run()
    assert performance.name == "part"
    assert performance.duration_s == pytest.approx(5.0, abs=0.1)
    assert np.isfinite(performance.motion.joint_positions("world")).all()
    assert performance.match.label == "good"  # the database holds that very motion
    assert not performance.match.is_guess


def test_progress_can_stop_a_reconstruction(files):
    job = reconstruct.reconstruct_job(*files, choice=MethodChoice(), best_quality=True)
    with pytest.raises(Cancelled):
        job.run(job.cancel)


def test_menus_list_what_the_core_knows():
    names = [name for name, _, _ in method_items()]
    assert names == ["path_regression", "tautges2011", "liu2011", "eom2014"]
    names = [name for name, _, _ in option_items("path_regression")]
    assert "num_paths" in names
    assert all("(" in text for _, _, text in option_items("tautges2011"))


def test_a_choice_is_read_from_what_operators_are_given():
    choice, renamed = choice_of("path_regression", "default", "num_paths=64, sharpness = 2")
    assert choice.options == (("num_paths", "64"), ("sharpness", "2"))
    assert renamed == ""
    choice, renamed = choice_of("", "paper", "")
    assert choice == MethodChoice("tautges2011")
    assert "--method tautges2011" in renamed
    with pytest.raises(InputError, match='"num_paths" is not NAME=VALUE'):
        choice_of("", "", "num_paths")


def test_options_reach_the_reconstruction(files):
    choice = MethodChoice(options=(("num_paths", "0"),))
    with pytest.raises(sparse_mocap.ConfigError, match="num_paths must be a whole number"):
        reconstruct.reconstruct_job(*files, choice=choice, best_quality=False).run()
