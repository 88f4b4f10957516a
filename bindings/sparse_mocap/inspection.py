# SPDX-License-Identifier: GPL-3.0-or-later
"""The content of a motion file, and how well the standard skeleton reproduces it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ._core import FormatError, MappingError, Motion, SkeletonMapping
from .mappings import find_mapping
from .motion_files import read_motion

__all__ = ["Inspection", "inspect_motion"]


@dataclass(frozen=True)
class Inspection:
    """One motion file. ``refusal`` is the reason if it cannot be used."""

    path: Path
    refusal: str | None = None
    motion: Motion | None = None
    mapping: SkeletonMapping | None = None
    standard: Motion | None = None
    """The motion on the standard skeleton, with the file's own proportions."""
    is_by_hand: bool = False
    limb_errors_deg: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Mean and worst angle between each limb of the file and of the standard skeleton."""
    warnings: tuple[str, ...] = ()

    @property
    def found_by(self) -> str:
        """How the joints were mapped: by hand, by names or by shape."""
        if self.mapping is None:
            return "-"
        if self.is_by_hand:
            return "hand"
        return "names" if self.mapping.is_by_names else "shape"

    @property
    def mean_error_deg(self) -> float:
        """Mean over the limbs; NaN where there is no mapping."""
        means = [mean for mean, _ in self.limb_errors_deg.values()]
        return sum(means) / len(means) if means else math.nan

    @property
    def worst_error_deg(self) -> float:
        """The worst angle of any limb in any frame; NaN where there is no mapping."""
        return max((worst for _, worst in self.limb_errors_deg.values()), default=math.nan)

    def described(self) -> dict[str, Any]:
        """Everything except the motions, for JSON."""
        motion, mapping = self.motion, self.mapping
        return {
            "path": str(self.path),
            "refusal": self.refusal,
            "joints": len(motion.skeleton.names) if motion else None,
            "frames": motion.num_frames if motion else None,
            "frame_time_s": motion.frame_time_s if motion else None,
            "found_by": self.found_by,
            "unit_scale": mapping.unit_scale if mapping else None,
            "mapping": mapping.joints if mapping else {},
            "extremities": mapping.extremities if mapping else {},
            "limb_errors_deg": {
                limb: {"mean": mean, "worst": worst}
                for limb, (mean, worst) in self.limb_errors_deg.items()
            },
            "warnings": list(self.warnings),
        }


def inspect_motion(
    path: Path,
    by_hand: Mapping[str, str] | None = None,
    reading: Mapping[str, Any] | None = None,
) -> Inspection:
    """Reads a motion file and transfers it to the standard skeleton.

    reading: keyword arguments of read_motion. The warnings end with what makes the motion doubtful.

    A file that cannot be read or mapped has a ``refusal``. Raises OSError.
    """
    try:
        motion, warnings = read_motion(path, **(reading or {}))
    except FormatError as error:
        return Inspection(path, refusal=str(error))
    try:
        mapping, notes = find_mapping(motion, by_hand)
    except MappingError as error:
        return Inspection(path, refusal=str(error), motion=motion, warnings=tuple(warnings))
    standard, more = mapping.to_standard(motion)
    errors = mapping.limb_errors_rad(motion, standard)
    return Inspection(
        path,
        motion=motion,
        mapping=mapping,
        standard=standard,
        is_by_hand=by_hand is not None or bool(notes),
        limb_errors_deg={
            limb: (math.degrees(mean), math.degrees(worst))
            for limb, (mean, worst) in errors.items()
        },
        warnings=(*warnings, *notes, *more, *mapping.faults(motion, standard)),
    )
