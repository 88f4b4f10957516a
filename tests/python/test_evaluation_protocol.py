# SPDX-License-Identifier: GPL-3.0-or-later
"""Which clips an evaluation tests, and what it hides from them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
from sparse_mocap import FormatError
from sparse_mocap.evaluation import (
    Content,
    choose_tests,
    excluded_clips,
    motion_files,
    source_path,
)


@dataclass
class FakeClip:
    name: str
    actor: str
    motion_class: str
    source: str
    source_hash: str
    is_mirrored: bool = False
    is_reversed: bool = False
    tempo: float = 1.0


def fake_clips() -> list[FakeClip]:
    clips = []
    for actor, kind, take in (
        ("a", "walk", 2), ("a", "walk", 1), ("a", "hop", 1), ("b", "walk", 1), ("b", "hop", 1),
    ):  # fmt: skip
        name = f"{actor}_{kind}_{take}"
        for mirrored in (False, True):
            clips.append(FakeClip(name, actor, kind, f"{name}.bvh", name, mirrored))
    clips.append(FakeClip("a_hop_1", "a", "hop", "a_hop_1.bvh", "a_hop_1", tempo=0.8))
    clips.append(FakeClip("copy", "b", "walk", "copy.bvh", "a_walk_1"))
    return clips


def names(clips: list[FakeClip], indices: list[int]) -> set[tuple[str, bool]]:
    return {(clips[i].name, clips[i].is_mirrored) for i in indices}


def test_one_clip_of_each_actor_and_class_is_tested() -> None:
    clips = fake_clips()
    tests = [clips[i].name for i in choose_tests(clips)]
    assert tests == ["a_hop_1", "a_walk_1", "b_hop_1", "b_walk_1"]


def test_more_clips_of_some_classes_can_be_tested() -> None:
    clips = fake_clips()
    walks = Content(classes=("w*",), actors=("a",))
    tests = [clips[i].name for i in choose_tests(clips, among=walks, per_class=2)]
    assert tests == ["a_walk_1", "a_walk_2"]
    half = Content(with_mirrored=False, every=2).rest(clips)
    shown = [clips[i].name for i in range(len(clips)) if i not in half]
    assert shown == ["a_walk_2", "a_hop_1", "b_walk_1", "a_hop_1"]


def test_a_pattern_on_file_names_chooses_other_tests() -> None:
    clips = fake_clips()
    assert [clips[i].name for i in choose_tests(clips, "A_walk*")] == ["a_walk_1", "a_walk_2"]
    assert choose_tests(clips, "nothing*") == []


@pytest.mark.parametrize("scenario", [1, 2, 3])
def test_a_scenario_hides_what_the_paper_says(scenario: int) -> None:
    clips = fake_clips()
    test = next(i for i, clip in enumerate(clips) if clip.name == "a_walk_1")
    hidden = excluded_clips(clips, test, scenario)
    shown = [i for i in range(len(clips)) if i not in hidden]
    both = {(name, side) for name in ("a_walk_2", "a_hop_1") for side in (False, True)}
    others = {(name, side) for name in ("b_walk_1", "b_hop_1") for side in (False, True)}
    assert names(clips, shown) == {1: both | others, 2: both, 3: others}[scenario]


def test_a_source_is_found_unless_it_is_unclear(tmp_path: Path) -> None:
    (tmp_path / "sub" / "sub").mkdir(parents=True)
    for name in ("a.bvh", "sub/a.bvh", "sub/B.BVH", "sub/sub/c.bvh", "sub/c.bvh", "x.asf"):
        (tmp_path / name).touch()
    files = motion_files(tmp_path)
    clip = fake_clips()[0]
    clip.source = "B.BVH"
    assert source_path(files, clip) == tmp_path / "sub" / "B.BVH"
    for clip.source in ("a.bvh", "sub/a.bvh"):
        assert source_path(files, clip) == tmp_path / clip.source
    for clip.source in ("c.bvh", "gone.bvh", "gone/a.bvh"):
        with pytest.raises(FormatError, match=clip.source):
            source_path(files, clip)
