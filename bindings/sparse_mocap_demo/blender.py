# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls Blender in the background, to write a scene and a picture of it."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

_RENDER_SCENE = Path(__file__).with_name("render_scene.py")
_EXAMPLE_SCENE = Path(__file__).with_name("example_scene.py")
_TIMEOUT_S = 900.0


@dataclass(frozen=True)
class Scene:
    """What Blender made, or why it made nothing."""

    blend: Path
    picture: Path
    fault: str = ""


def find_blender(named: Path | None = None) -> str | None:
    """Returns the Blender that was named, else $BLENDER, else the one on PATH; None if none is."""
    if named is not None:
        return shutil.which(named)
    return shutil.which(os.environ.get("BLENDER") or "blender")


def render(blender: str, performed: Path, reconstructed: Path, folder: Path) -> Scene:
    """Writes take.blend and figures.png into a folder, from two motions on one skeleton."""
    scene = Scene(folder / "take.blend", folder / "figures.png")
    arguments = ["--performed", str(performed), "--reconstructed", str(reconstructed)]
    arguments += ["--blend", str(scene.blend), "--picture", str(scene.picture)]
    wanted = [scene.blend, scene.picture]
    fault = _run(blender, _RENDER_SCENE, arguments, wanted, folder / "blender.log")
    return replace(scene, fault=fault)


def make_example(blender: str, path: Path) -> str:
    """Writes the .blend file that *Try It* of the add-on makes; returns why it did not, or ""."""
    log = path.with_name("example.log")
    return _run(blender, _EXAMPLE_SCENE, ["--blend", str(path)], [path], log)


def _run(blender: str, script: Path, arguments: list[str], wanted: list[Path], log: Path) -> str:
    """Runs a script in Blender that writes the wanted files; returns what went wrong, or ""."""
    for path in wanted:
        path.unlink(missing_ok=True)
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", str(script), "--", *arguments]
    try:
        with log.open("w", encoding="utf-8") as output:
            code = subprocess.run(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                timeout=_TIMEOUT_S,
                check=False,
            ).returncode
    except subprocess.TimeoutExpired:
        return f"did not end in {_TIMEOUT_S:.0f} s; see {log}"
    missing = [path.name for path in wanted if not path.exists()]
    if code != 0 or missing:
        what = f"ended with code {code}" + (f" without {' and '.join(missing)}" if missing else "")
        return f"{what}; see {log}"
    return ""
