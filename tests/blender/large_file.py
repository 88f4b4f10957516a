# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion file that takes a while to import."""

from __future__ import annotations

from pathlib import Path


def large_file(folder: Path) -> str:
    """A .bvh of 8 joints and 8,000 frames, for the scenarios in a window."""
    path = folder / "large.bvh"
    lines, channels = ["HIERARCHY"], "CHANNELS 3 Zrotation Xrotation Yrotation"
    for index in range(8):
        word, offset = ("JOINT", "0 10 0") if index else ("ROOT", "0 90 0")
        lines += [f"{word} j{index}", "{", f"OFFSET {offset}", channels]
    lines += ["}"] * 8 + ["MOTION", "Frames: 8000", "Frame Time: 0.01"]
    lines += [" ".join([f"{0.01 * row:.2f}"] * 24) for row in range(8000)]
    path.write_text("\n".join(lines))
    return str(path)
