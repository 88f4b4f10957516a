# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import PureWindowsPath

from blender_addon.session.names import file_name, fitting


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


def test_names_of_actions_become_names_of_files_on_windows():
    kept = ["walk 01", "Läufe", "a.b", "console", "lpt", "com", "a.con"]
    assert [file_name(name) for name in kept] == kept
    changed = [
        "Armature|mixamo.com|Layer0",
        'a<b>c:d"e\\f/g?h*i\tj',
        "walk. .",
        "NUL",
        "aux.x",
        "",
        "...",
    ]
    for name in changed:
        made = PureWindowsPath(file_name(name))
        assert made.name == file_name(name) != name
        assert made.name.partition(".")[0].lower() not in ("nul", "aux")
        assert not set(made.name) & set('<>:"/\\|?*\t')
        assert made.name[-1] not in " ."
    assert file_name("Armature|Scene") == "Armature_Scene"
