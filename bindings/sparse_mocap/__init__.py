# SPDX-License-Identifier: GPL-3.0-or-later
"""Full-body motion from a few inertial sensors and a database of motion capture.

Names are loaded when they are first used, so that what needs no compiled core (the generator of
the demonstration's motions) works without one.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._core import (
        FILTER_REACH_S,
        GRAVITY_MPS2,
        SAMPLE_FLAGS,
        BuildReport,
        Cancelled,
        Clip,
        ClockModel,
        ConfigError,
        FormatError,
        InclinationFilter,
        MappingError,
        Motion,
        MotionDatabase,
        PoseEstimate,
        ProgressReport,
        Reconstruction,
        Reconstructor,
        Resampler,
        Skeleton,
        SkeletonMapping,
        SourceSkeleton,
        StreamEncoder,
        StreamParser,
        __version__,
        align_in_time,
        calibrate_sensor,
        driver_names,
        driver_options,
        drop_from_database,
        filtered_at,
        find_motion_files,
        guided_movements,
        inclinations,
        keep_alive_commands,
        map_skeleton,
        method_names,
        nearest_poses,
        nearest_windows,
        playback_best_path,
        preset_names,
        read_mapping,
        read_motion,
        simulate,
        site_names,
        standard_joint_names,
        standard_motion,
        standing_pose_names,
        start_commands,
        write_acclaim,
        write_bvh,
        write_mapping,
    )
    from .alignment import aligned
    from .calibration import Calibration, SensorCalibration, Steps, assign_by_shaking, calibrate
    from .calibration_file import read_calibration, write_calibration
    from .databases import add_to_database, build_database
    from .mappings import forget_mapping, mapping_folder, remember_mapping, to_standard
    from .noise import NoiseModel, noise_presets, noisy
    from .positions import read_positions, write_positions
    from .readings import Readings, readings_of
    from .take import SensorRecord, Take, TakeError, read_take, resampled, simulated, write_take

__all__ = [
    "FILTER_REACH_S",
    "GRAVITY_MPS2",
    "SAMPLE_FLAGS",
    "BuildReport",
    "Calibration",
    "Cancelled",
    "Clip",
    "ClockModel",
    "ConfigError",
    "FormatError",
    "InclinationFilter",
    "MappingError",
    "Motion",
    "MotionDatabase",
    "NoiseModel",
    "PoseEstimate",
    "ProgressReport",
    "Readings",
    "Reconstruction",
    "Reconstructor",
    "Resampler",
    "SensorCalibration",
    "SensorRecord",
    "Skeleton",
    "SkeletonMapping",
    "SourceSkeleton",
    "Steps",
    "StreamEncoder",
    "StreamParser",
    "Take",
    "TakeError",
    "__version__",
    "add_to_database",
    "align_in_time",
    "aligned",
    "assign_by_shaking",
    "build_database",
    "calibrate",
    "calibrate_sensor",
    "driver_names",
    "driver_options",
    "drop_from_database",
    "filtered_at",
    "find_motion_files",
    "forget_mapping",
    "guided_movements",
    "inclinations",
    "keep_alive_commands",
    "map_skeleton",
    "mapping_folder",
    "method_names",
    "nearest_poses",
    "nearest_windows",
    "noise_presets",
    "noisy",
    "playback_best_path",
    "preset_names",
    "read_calibration",
    "read_mapping",
    "read_motion",
    "read_positions",
    "read_take",
    "readings_of",
    "remember_mapping",
    "resampled",
    "simulate",
    "simulated",
    "site_names",
    "standard_joint_names",
    "standard_motion",
    "standing_pose_names",
    "start_commands",
    "to_standard",
    "write_acclaim",
    "write_bvh",
    "write_calibration",
    "write_mapping",
    "write_positions",
    "write_take",
]

_PYTHON_HOMES = {
    **dict.fromkeys(("NoiseModel", "noise_presets", "noisy"), ".noise"),
    **dict.fromkeys(
        ("forget_mapping", "mapping_folder", "remember_mapping", "to_standard"), ".mappings"
    ),
    "aligned": ".alignment",
    **dict.fromkeys(("add_to_database", "build_database"), ".databases"),
    **dict.fromkeys(
        ("Calibration", "SensorCalibration", "Steps", "assign_by_shaking", "calibrate"),
        ".calibration",
    ),
    **dict.fromkeys(("read_calibration", "write_calibration"), ".calibration_file"),
    **dict.fromkeys(("read_positions", "write_positions"), ".positions"),
    **dict.fromkeys(("Readings", "readings_of"), ".readings"),
    **dict.fromkeys(
        ("SensorRecord", "Take", "TakeError", "read_take", "resampled", "simulated", "write_take"),
        ".take",
    ),
}

_RENAMED = {"HumanoidMapping": "SkeletonMapping", "map_humanoid": "map_skeleton"}
"""Names of the release before, and what they are called now."""


def __getattr__(name: str) -> Any:
    if new_name := _RENAMED.get(name):
        warnings.warn(
            f"sparse_mocap.{name} will go: write sparse_mocap.{new_name}",
            DeprecationWarning,
            stacklevel=2,
        )
        return getattr(sys.modules[__name__], new_name)
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = _PYTHON_HOMES.get(name)
    module = importlib.import_module(home, __name__) if home else _compiled()
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _compiled() -> Any:
    """Return the compiled module; ImportError in one line when this Python cannot load it."""
    try:
        return importlib.import_module("._core", __name__)
    except ImportError as error:
        version = ".".join(map(str, sys.version_info[:3]))
        built = sorted(path.name for path in Path(__file__).parent.glob("_core*.so"))
        found = f"the folder holds {', '.join(built)}" if built else "none is built"
        raise ImportError(
            f"sparse_mocap has no compiled core for this Python, CPython {version} ({found}): "
            f"install the wheel of this version or build it; {error}",
            name=f"{__name__}._core",
        ) from None
