# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies: their file, and where they come from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sparse_mocap import (
    Body,
    ConfigError,
    FormatError,
    body_of_height,
    body_of_motion,
    read_body,
    read_motion,
    standard_joint_names,
    standard_motion,
    write_body,
)


def test_a_body_file_gives_back_what_was_written(performance: Path, tmp_path: Path) -> None:
    body = body_of_motion(performance, "anna")
    path = tmp_path / "anna.json"
    write_body(path, body, "performance.bvh")
    read = read_body(path)
    assert read.performer == "anna"
    np.testing.assert_array_equal(read.bones, body.bones)
    np.testing.assert_array_equal(read.skeleton.bones, body.bones)
    told = json.loads(path.read_text(encoding="utf-8"))
    assert (told["format"], told["format_version"]) == ("sparse_mocap_body", 1)
    assert told["source"] == "performance.bvh"
    assert list(told["bones_m"]) == standard_joint_names()


def test_a_body_has_the_proportions_of_its_motion(performance: Path) -> None:
    body = body_of_motion(performance)
    assert body.performer == performance.stem
    motion = standard_motion(read_motion(performance)[0])[0]
    np.testing.assert_array_equal(body.bones, motion.skeleton.bones)
    ends, pivots = motion.joint_positions(), motion.pivot_positions()
    lengths = np.linalg.norm(ends - pivots, axis=2)
    np.testing.assert_allclose(np.linalg.norm(body.bones, axis=1), lengths[0], atol=1e-9)
    assert 1.4 < body.height_m < 2.1


def test_a_body_of_a_height_is_so_tall() -> None:
    small, tall = body_of_height(1.5), body_of_height(1.95)
    assert tall.height_m == pytest.approx(1.95)
    np.testing.assert_allclose(tall.bones, small.bones * 1.95 / 1.5)
    for height in (175, 0.0, float("nan")):
        with pytest.raises(ConfigError, match=r"between 0\.5 and 2\.5 m"):
            body_of_height(height)


def test_bones_that_nobody_has_are_refused() -> None:
    bones = body_of_height(1.7).bones
    with pytest.raises(ConfigError, match="must be at most 1 m"):
        Body(100 * bones)
    with pytest.raises(ValueError, match="bones must have shape"):
        Body(bones[:20])
    with pytest.raises(ConfigError, match="'lfemur'"):
        Body(np.where(np.arange(21)[:, None] == 2, np.nan, bones))


def test_a_motion_of_no_body_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "none.bvh"
    path.write_text("HIERARCHY\n", encoding="utf-8")
    with pytest.raises(FormatError):
        body_of_motion(path)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"format": "sparse_mocap_mapping"}, "is not a body file"),
        ({"format_version": 2}, "of format version 2, and this program reads version 1"),
        ({"format_version": "1"}, 'of format version "1", and'),
        ({"format_version": None}, "of format version null, and"),
        ({"format_version": True}, "of format version true, and"),
        ({"performr": "x"}, "performr is unknown; the nearest is performer"),
        ({"performer": 5}, "performer must be a text"),
        ({"bones_m": []}, "bones_m must be an object"),
        ({"bones_m": {}}, "bones_m.root is missing"),
        ({"lfemur": [0, -0.4]}, "bones_m.lfemur must be three numbers"),
        ({"lfemur": ["0", "1", "2"]}, "bones_m.lfemur must be three numbers"),
        ({"lfemur": [True, 0, 0]}, "bones_m.lfemur must be three numbers"),
        ({"lfemur": [0, -40, 0]}, "'lfemur' must be at most 1 m long"),
        ({"lfemur": [0, float("nan"), 0]}, "'lfemur' must be at most 1 m long"),
        ({"lfemor": [0, 0, 0]}, "bones_m.lfemor is unknown; the nearest is lfemur"),
    ],
)
def test_a_bad_body_file_says_what_is_wrong(
    tmp_path: Path, change: dict[str, Any], part: str
) -> None:
    path = tmp_path / "body.json"
    write_body(path, body_of_height(1.7))
    whole = json.loads(path.read_text(encoding="utf-8"))
    for key, value in change.items():
        (whole["bones_m"] if key in ("lfemur", "lfemor") else whole)[key] = value
    path.write_text(json.dumps(whole), encoding="utf-8")
    with pytest.raises(FormatError) as caught:
        read_body(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert part in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_text_that_is_no_json_names_the_line(tmp_path: Path) -> None:
    path = tmp_path / "body.json"
    for text, part in (("{\n]", ":2: is not JSON"), ('{"a": 1, "a": 2}', "repeats the key 'a'")):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(FormatError, match=part):
            read_body(path)
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(FormatError, match="UTF-16"):
        read_body(path)
    with pytest.raises(FileNotFoundError):
        read_body(tmp_path / "none.json")
