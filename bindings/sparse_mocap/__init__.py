# SPDX-License-Identifier: GPL-3.0-or-later
"""Full-body motion from a few inertial sensors and a database of motion capture.

Names are loaded when they are first used, so that the package can be imported, and say what is
missing, where its compiled core cannot be loaded.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._core import (
        CHANNEL_NAMES,
        FILTER_REACH_S,
        GRAVITY_MPS2,
        LARGEST_CLOCK_DRIFT,
        SAMPLE_FLAGS,
        Body,
        BuildReport,
        Cancelled,
        Clip,
        ClockModel,
        ConfigError,
        FormatError,
        MappingError,
        Model,
        Motion,
        MotionDatabase,
        PoseEstimate,
        ProgressReport,
        Readings,
        ReadingStream,
        Reconstruction,
        SensorInput,
        SensorRecording,
        Skeleton,
        SkeletonMapping,
        SourceSkeleton,
        StreamEncoder,
        StreamParser,
        TrainingClip,
        __version__,
        align_in_time,
        body_of_height,
        calibrate_sensor,
        channels_of,
        clip_segments,
        driver_names,
        driver_options,
        drop_from_database,
        filtered_at,
        graph_times,
        gravity_directions,
        guided_movements,
        host_times,
        keep_alive_commands,
        map_skeleton,
        nearest_poses,
        nearest_windows,
        playback_best_path,
        read_mapping,
        read_model,
        remove_model,
        simulate,
        site_names,
        spread_evenly,
        standard_joint_names,
        standard_motion,
        standing_pose_names,
        start_commands,
        store_model,
        train,
        with_extremities,
        write_acclaim,
        write_bvh,
        write_mapping,
        write_model,
    )
    from .alignment import aligned
    from .body_file import body_of_motion, read_body, write_body
    from .calibration import Calibration, SensorCalibration, Steps, assign_by_shaking, calibrate
    from .calibration_file import read_calibration, write_calibration
    from .databases import add_to_database, build_database
    from .mappings import forget_mapping, mapping_folder, remember_mapping, to_standard
    from .methods import MethodInfo, OptionInfo, method_info
    from .motion_files import find_motion_files, read_motion
    from .noise import NoiseModel, noise_presets, noisy
    from .positions import read_positions, write_positions
    from .reconstruction import LiveReconstructor, reconstruct
    from .take import SensorRecord, Take, TakeError, read_take, simulated, write_take
    from .teaching import Pairing, TaughtClip, pair_take, teach_database

__all__ = [
    "CHANNEL_NAMES",
    "FILTER_REACH_S",
    "GRAVITY_MPS2",
    "LARGEST_CLOCK_DRIFT",
    "SAMPLE_FLAGS",
    "Body",
    "BuildReport",
    "Calibration",
    "Cancelled",
    "Clip",
    "ClockModel",
    "ConfigError",
    "FormatError",
    "LiveReconstructor",
    "MappingError",
    "MethodInfo",
    "Model",
    "Motion",
    "MotionDatabase",
    "NoiseModel",
    "OptionInfo",
    "Pairing",
    "PoseEstimate",
    "ProgressReport",
    "ReadingStream",
    "Readings",
    "Reconstruction",
    "SensorCalibration",
    "SensorInput",
    "SensorRecord",
    "SensorRecording",
    "Skeleton",
    "SkeletonMapping",
    "SourceSkeleton",
    "Steps",
    "StreamEncoder",
    "StreamParser",
    "Take",
    "TakeError",
    "TaughtClip",
    "TrainingClip",
    "__version__",
    "add_to_database",
    "align_in_time",
    "aligned",
    "assign_by_shaking",
    "body_of_height",
    "body_of_motion",
    "build_database",
    "calibrate",
    "calibrate_sensor",
    "channels_of",
    "clip_segments",
    "driver_names",
    "driver_options",
    "drop_from_database",
    "filtered_at",
    "find_motion_files",
    "forget_mapping",
    "graph_times",
    "gravity_directions",
    "guided_movements",
    "host_times",
    "keep_alive_commands",
    "map_skeleton",
    "mapping_folder",
    "method_info",
    "nearest_poses",
    "nearest_windows",
    "noise_presets",
    "noisy",
    "pair_take",
    "playback_best_path",
    "read_body",
    "read_calibration",
    "read_mapping",
    "read_model",
    "read_motion",
    "read_positions",
    "read_take",
    "reconstruct",
    "remember_mapping",
    "remove_model",
    "simulate",
    "simulated",
    "site_names",
    "spread_evenly",
    "standard_joint_names",
    "standard_motion",
    "standing_pose_names",
    "start_commands",
    "store_model",
    "teach_database",
    "to_standard",
    "train",
    "with_extremities",
    "write_acclaim",
    "write_body",
    "write_bvh",
    "write_calibration",
    "write_mapping",
    "write_model",
    "write_positions",
    "write_take",
]

_PYTHON_HOMES = {
    **dict.fromkeys(("NoiseModel", "noise_presets", "noisy"), ".noise"),
    **dict.fromkeys(
        ("forget_mapping", "mapping_folder", "remember_mapping", "to_standard"), ".mappings"
    ),
    **dict.fromkeys(("find_motion_files", "read_motion"), ".motion_files"),
    "aligned": ".alignment",
    **dict.fromkeys(("body_of_motion", "read_body", "write_body"), ".body_file"),
    **dict.fromkeys(("add_to_database", "build_database"), ".databases"),
    **dict.fromkeys(
        ("Calibration", "SensorCalibration", "Steps", "assign_by_shaking", "calibrate"),
        ".calibration",
    ),
    **dict.fromkeys(("read_calibration", "write_calibration"), ".calibration_file"),
    **dict.fromkeys(("read_positions", "write_positions"), ".positions"),
    **dict.fromkeys(("MethodInfo", "OptionInfo", "method_info"), ".methods"),
    **dict.fromkeys(("LiveReconstructor", "reconstruct"), ".reconstruction"),
    **dict.fromkeys(("Pairing", "TaughtClip", "pair_take", "teach_database"), ".teaching"),
    **dict.fromkeys(
        ("SensorRecord", "Take", "TakeError", "read_take", "simulated", "write_take"),
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
        files = Path(__file__).parent.glob("_core*")
        built = sorted(path.name for path in files if path.suffix in (".so", ".pyd"))
        found = f"the folder holds {', '.join(built)}" if built else "none is built"
        raise ImportError(
            f"sparse_mocap has no compiled core for this Python, CPython {version} ({found}): "
            f"install the wheel of this version or build it; {error}",
            name=f"{__name__}._core",
        ) from None
