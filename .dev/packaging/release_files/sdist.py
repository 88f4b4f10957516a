# SPDX-License-Identifier: GPL-3.0-or-later
"""The source archive from which ``pip install`` builds the package."""

from pathlib import Path

from .archives import folder_files, under
from .errors import PackagingError
from .project import Project
from .wheels import PACKAGE, metadata

SOURCES = (".cpp", ".hpp", ".txt", ".map")
MOVED = {
    'cmake.source-dir = ".."': 'cmake.source-dir = "."',
    'wheel.packages = ["sparse_mocap"]': 'wheel.packages = ["bindings/sparse_mocap"]',
}
"""In the repository pyproject.toml is in bindings/, in an archive it must be at the top."""


def sdist_name(project: Project) -> str:
    """The name that pip looks for, without the ending."""
    return f"{PACKAGE}-{project.version}"


def sdist_files(root: Path, project: Project) -> dict[str, bytes]:
    """What the source archive holds: the core, the bindings, and how they are built."""
    files = {
        **project.licences,
        **under("core", folder_files(root / "core", SOURCES)),
        **under("bindings/src", folder_files(root / "bindings" / "src", SOURCES)),
        **under("bindings/sparse_mocap", project.package),
        "CMakeLists.txt": (root / "CMakeLists.txt").read_bytes(),
        "PKG-INFO": metadata(project),
        "pyproject.toml": _at_the_top((root / "bindings" / "pyproject.toml").read_text("utf-8")),
    }
    for name in ("CMakeLists.txt", "exports.map"):
        files[f"bindings/{name}"] = (root / "bindings" / name).read_bytes()
    return under(sdist_name(project), files)


def _at_the_top(text: str) -> bytes:
    for old, new in MOVED.items():
        if old not in text:
            raise PackagingError(f"bindings/pyproject.toml has no line {old}: mend sdist.py")
        text = text.replace(old, new)
    return text.encode()
