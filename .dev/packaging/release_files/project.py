# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sources say of the project: its version, its description, its licences."""

import ast
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .archives import Files, folder_files, under
from .errors import PackagingError


@dataclass(frozen=True)
class Project:
    """What every file that is handed out is made of, beside the compiled modules."""

    version: str
    settings: dict[str, Any]
    """The table ``project`` of bindings/pyproject.toml."""
    manifest: str
    package: Files
    """The Python files of the package ``sparse_mocap``, by their names in it."""
    addon: Files
    """The Python files of the add-on."""
    licences: Files
    """The project's licence, and in a folder those of what is linked in or comes along."""


def read_project(root: Path) -> Project:
    """Read the sources; PackagingError when they disagree about the version."""
    version = read_version(root)
    settings = tomllib.loads((root / "bindings" / "pyproject.toml").read_text("utf-8"))
    return Project(
        version=version,
        settings=settings["project"],
        manifest=(root / "blender_addon" / "blender_manifest.toml").read_text("utf-8"),
        package=folder_files(
            root / "bindings" / "sparse_mocap", (".py", ".pyi", ".ino", "py.typed")
        ),
        addon=folder_files(root / "blender_addon", (".py",)),
        licences={
            "LICENSE": (root / "LICENSE").read_bytes(),
            **under("licences", folder_files(root / ".dev" / "packaging" / "licences", (".txt",))),
        },
    )


def read_version(root: Path) -> str:
    """The version in CMakeLists.txt; PackagingError when another file names a different one."""
    version = _in_cmake(root / "CMakeLists.txt")
    others = {
        "bindings/pyproject.toml": _in_pyproject,
        "blender_addon/blender_manifest.toml": _in_manifest,
        "blender_addon/__init__.py": _in_bl_info,
    }
    wrong = [
        f"{name} says version {found}, CMakeLists.txt {version}: make them equal"
        for name, read in others.items()
        if (found := read(root / name)) != version
    ]
    if wrong:
        raise PackagingError("\n".join(wrong))
    return version


def _in_cmake(path: Path) -> str:
    found = re.search(r"^project\(\S+ VERSION (\d+\.\d+\.\d+)\b", path.read_text("utf-8"), re.M)
    if not found:
        raise PackagingError(f"{path.name} names no version: project(NAME VERSION x.y.z ...)")
    return found[1]


def _in_pyproject(path: Path) -> str:
    return str(tomllib.loads(path.read_text("utf-8"))["project"]["version"])


def _in_manifest(path: Path) -> str:
    return str(tomllib.loads(path.read_text("utf-8"))["version"])


def _in_bl_info(path: Path) -> str:
    for node in ast.parse(path.read_text("utf-8")).body:
        match node:
            case ast.Assign(targets=[ast.Name(id="bl_info")], value=value):
                return ".".join(map(str, ast.literal_eval(value)["version"]))
    return "nothing"
