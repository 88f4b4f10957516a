# SPDX-License-Identifier: GPL-3.0-or-later
"""That a release says which of its modules were tested, by their hashes."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path
from types import ModuleType

import pytest
from loaded_module import loaded_module
from release_files import tested
from release_files.errors import PackagingError

FIRST, SECOND = ({"name": f"_core.{i}.so", "sha256": str(i) * 64} for i in (1, 2))


def test_a_run_names_the_module_that_it_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "_core.so"
    path.write_bytes(b"compiled")
    module = ModuleType("sparse_mocap._core")
    module.__file__ = str(path)
    monkeypatch.setitem(sys.modules, "sparse_mocap._core", module)
    line = f"Compiled module: _core.so {hashlib.sha256(b'compiled').hexdigest()}"
    assert loaded_module() == line
    assert tested.LOADED.findall(f"a\n{line}\nb") == [tuple(line.split()[2:])]
    monkeypatch.delitem(sys.modules, "sparse_mocap._core")
    assert loaded_module() == "Compiled module: none"


def test_each_module_gets_its_suites() -> None:
    report = {"modules": [dict(FIRST), dict(SECOND)]}
    line = f"Compiled module: {FIRST['name']} {FIRST['sha256']}\n"
    tested.note_tests(report, {"Python": f"9 passed\n{line}"})
    tested.note_tests(report, {"Python": line, "Blender 3.4.1": line})
    assert [module["tested_by"] for module in report["modules"]] == [
        ["Python", "Blender 3.4.1"],
        [],
    ]


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("Compiled module: none", "does not say which compiled module"),
        (f"Compiled module: _core.1.so {'2' * 64}", "ran on another _core.1.so than is handed out"),
    ],
)
def test_a_suite_on_another_module_is_refused(line: str, fault: str) -> None:
    with pytest.raises(PackagingError, match=f"^Python {fault}"):
        tested.note_tests({"modules": [dict(FIRST)]}, {"Python": line})
