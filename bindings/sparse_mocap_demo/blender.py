# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls Blender in the background, to write a scene and a picture of it."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

_SCRIPT = Path(__file__).with_name("render_scene.py")
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
    for path in (scene.blend, scene.picture):
        path.unlink(missing_ok=True)
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", str(_SCRIPT), "--"]
    command += ["--performed", str(performed), "--reconstructed", str(reconstructed)]
    command += ["--blend", str(scene.blend), "--picture", str(scene.picture)]
    log = folder / "blender.log"
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
        return Scene(scene.blend, scene.picture, f"did not end in {_TIMEOUT_S:.0f} s; see {log}")
    missing = [path.name for path in (scene.blend, scene.picture) if not path.exists()]
    if code != 0 or missing:
        what = f"ended with code {code}" + (f" without {' and '.join(missing)}" if missing else "")
        return Scene(scene.blend, scene.picture, f"{what}; see {log}")
    return scene
