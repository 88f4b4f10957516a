# SPDX-License-Identifier: GPL-3.0-or-later
"""No lower module uses a higher one, and what is shipped does not use what is not."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BINDINGS = ROOT / "bindings"
CORE = ROOT / "core" / "sparse_mocap"


def imported(path: Path, root: Path) -> set[str]:
    """The full names of all that a Python file under root imports, wherever in the file."""
    package = list(path.relative_to(root).parts[:-1])
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            names |= {module, *(f"{module}.{alias.name}" for alias in node.names)}
    return names


def users(folder: Path, root: Path, module: str) -> list[str]:
    """The files of a folder that import a module or something in it."""
    files = sorted(folder.rglob("*.py"))
    assert files
    return [
        str(path.relative_to(root))
        for path in files
        if any(f"{name}.".startswith(f"{module}.") for name in imported(path, root))
    ]


@pytest.mark.parametrize(
    "line",
    [
        "import a.b.cli.app",
        "from a.b import cli",
        "from a.b.cli import app",
        "from ..cli import app",
        "from .. import cli",
        "def f():\n    from ..cli.app import app",
    ],
)
def test_an_import_is_found_however_it_is_written(tmp_path: Path, line: str) -> None:
    room = tmp_path / "a" / "b" / "c"
    room.mkdir(parents=True)
    (room / "d.py").write_text(line)
    (room / "e.py").write_text("from a.b import clip\nfrom .cli import app\nimport cli")
    assert users(tmp_path, tmp_path, "a.b.cli") == ["a/b/c/d.py"]


@pytest.mark.parametrize("module", ["sparse_mocap_demo", "blender_addon", "tests"])
def test_the_package_uses_nothing_that_is_not_shipped_with_it(module: str) -> None:
    assert users(BINDINGS / "sparse_mocap", BINDINGS, module) == []


def test_the_wheel_holds_the_package_alone() -> None:
    settings = tomllib.loads((BINDINGS / "pyproject.toml").read_text(encoding="utf-8"))
    assert settings["tool"]["scikit-build"]["wheel"]["packages"] == ["sparse_mocap"]


def test_only_the_command_uses_the_command_line() -> None:
    found = users(BINDINGS / "sparse_mocap", BINDINGS, "sparse_mocap.cli")
    assert [path for path in found if not path.startswith("sparse_mocap/cli/")] == [
        "sparse_mocap/__main__.py"
    ]


@pytest.mark.parametrize("package", ["capture", "imports"])
def test_what_reads_sensors_does_not_use_the_evaluation(package: str) -> None:
    assert users(BINDINGS / "sparse_mocap" / package, BINDINGS, "sparse_mocap.evaluation") == []


def test_the_core_modules_use_each_other_one_way() -> None:
    uses: dict[str, set[str]] = {}
    for path in sorted(CORE.rglob("*.[ch]pp")):
        room = path.relative_to(CORE).parts[0]
        found = re.findall(r'#include "sparse_mocap/(\w+)/', path.read_text(encoding="utf-8"))
        uses.setdefault(room, set()).update(set(found) - {room})
    assert len(uses) > 5
    while free := {room for room, used in uses.items() if not used & uses.keys()}:
        uses = {room: used for room, used in uses.items() if room not in free}
    assert uses == {}, "these modules use each other in a circle"
