# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an installation lies, and paths without the user's name; needs neither bpy nor NumPy."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path

PACKAGE = "sparse_mocap"


def addon_version(addon: Path) -> str:
    """The version of the add-on in that folder; empty when no file tells."""
    manifest = _text(addon / "blender_manifest.toml")
    if found := re.search(r'^version\s*=\s*"([^"]+)"', manifest, re.MULTILINE):
        return found[1]
    found = re.search(r'"version":\s*\(([\d, ]+)\)', _text(addon / "__init__.py"))
    return ".".join(found[1].replace(" ", "").strip(",").split(",")) if found else ""


def package_version(package: Path) -> str:
    """The version in the metadata beside a package's folder; empty when there is none."""
    for metadata in sorted(package.parent.glob(f"{PACKAGE}-*.dist-info")):
        return metadata.name.removesuffix(".dist-info").removeprefix(f"{PACKAGE}-")
    return ""


def own_folders(addon: Path, *, is_extension: bool) -> list[Path]:
    """The folders in which the package that belongs to the add-on may be installed.

    A legacy add-on has it in ``vendor``; Blender puts that of an extension beside all extensions.
    """
    folders = [addon / "vendor"]
    if is_extension:
        python = f"python{sys.version_info.major}.{sys.version_info.minor}"
        wheels = Path(".local", "lib", python, "site-packages")
        folders.append(addon.parents[1] / wheels)
        folders += [Path(entry) for entry in sys.path if "extensions" in Path(entry).parts
                    and Path(entry).parts[-4:] == wheels.parts]  # fmt: skip
    return list(dict.fromkeys(folders))


def own_package(folders: Iterable[Path]) -> Path | None:
    """The package in the first of these folders that has it."""
    return next((f / PACKAGE for f in folders if (f / PACKAGE).is_dir()), None)


def entries_with_package() -> list[Path]:
    """The packages that Python's search path leads to."""
    entries = [Path(entry or ".") / PACKAGE for entry in dict.fromkeys(sys.path)]
    return [entry for entry in entries if entry.is_dir()]


def home_hidden(text: str, home: Path | None = None) -> str:
    """The text with ``~`` for the home folder, and no user's name in other paths."""
    home = home or Path(os.path.expanduser("~"))
    for folder in sorted({str(home), str(home.resolve()), home.as_posix()}, key=len, reverse=True):
        if len(folder) > 1:
            flags = re.IGNORECASE if "\\" in folder else 0
            text = re.sub(rf"{re.escape(folder)}(?![\w.-])", "~", text, flags=flags)
    names = {home.name, *(os.environ.get(key, "") for key in ("USER", "USERNAME", "LOGNAME"))}
    for name in names - {""}:
        text = re.sub(rf"(?<=[\\/]){re.escape(name)}(?=[\\/]|$|[\s:;,)'\"])", "USER", text)
    return text


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
