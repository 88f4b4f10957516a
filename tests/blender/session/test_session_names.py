# SPDX-License-Identifier: GPL-3.0-or-later
from blender_addon.session.names import fitting


def test_short_names_stay():
    assert fitting(["mixamorig:Hips", 'say "it"', "ü"]) == ["mixamorig:Hips", 'say "it"', "ü"]


def test_long_names_are_cut_between_letters_and_told_apart():
    names = fitting(["a" * 63, "a" * 64, "a" * 65, "ü" * 40, "x" + "ü" * 40])
    assert names == ["a" * 63, "a" * 59 + ".001", "a" * 59 + ".002", "ü" * 31, "x" + "ü" * 31]
    assert all(len(name.encode()) <= 63 for name in names)


def test_many_alike():
    names = fitting(["b" * 80] * 1024)
    assert len(set(names)) == 1024
    assert all(len(name.encode()) <= 63 for name in names)
