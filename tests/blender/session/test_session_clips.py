# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import pytest

from blender_addon.session.clips import ClipRow, ClipTable, table_of

ROWS = [
    ClipRow("walk_02", "bd", "walk", 3.0, ""),
    ClipRow("Walk_01", "tr", "walk", 5.0, ""),
    ClipRow("sit", "bd", "sitDown", 1.0, ""),
    ClipRow("sit", "bd", "sitDown", 1.0, "mirrored"),
]


def _listed(text="", copies=False, key="name"):
    table = ClipTable(ROWS)
    chosen, order = table.chosen(text, copies), table.order(key)
    ranked = sorted(range(len(ROWS)), key=order.__getitem__)
    return [ROWS[index].label for index in ranked if chosen[index]]


def test_copies_are_hidden_until_asked_for():
    assert _listed() == ["sit", "Walk_01", "walk_02"]
    assert _listed(copies=True) == ["sit", "sit (mirrored)", "Walk_01", "walk_02"]


def test_sorts_by_length_and_actor():
    assert _listed(key="length") == ["sit", "walk_02", "Walk_01"]
    assert _listed(key="actor") == ["sit", "walk_02", "Walk_01"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [("WALK", ["Walk_01", "walk_02"]), ("bd walk", ["walk_02"]), ("sitdown", ["sit"]), ("x", [])],
)
def test_all_words_are_searched_in_name_actor_and_class(text, expected):
    assert _listed(text) == expected


def test_rows_tell_which_copy_a_clip_is():
    def clip(**facts):
        plain = {"is_mirrored": False, "is_reversed": False, "tempo": 1.0, "begin": 50, "end": 100}
        names = {"name": "a", "actor": "b", "motion_class": "c"}
        return SimpleNamespace(**{**plain, **names, **facts})

    table = table_of(
        [clip(), clip(is_mirrored=True, tempo=0.8), clip(is_reversed=True, end=75)], 25.0
    )
    assert [row.copy for row in table.rows] == ["", "mirrored, 0.8x", "reversed"]
    assert [row.length_s for row in table.rows] == [2.0, 2.0, 1.0]
    assert table.has_copies
    assert not ClipTable(ROWS[:3]).has_copies
