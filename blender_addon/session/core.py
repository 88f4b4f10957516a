# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the package ``sparse_mocap``, installed or in the add-on's ``vendor`` folder."""

import importlib
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from .errors import InputError, one_line

VENDOR = Path(__file__).resolve().parents[1] / "vendor"
MODULES = (
    "sparse_mocap._core",
    "sparse_mocap.calibration_file",
    "sparse_mocap.databases",
    "sparse_mocap.mappings",
    "sparse_mocap.methods",
    "sparse_mocap.readings",
    "sparse_mocap.reconstruction",
    "sparse_mocap.report",
    "sparse_mocap.take",
)
CAPTURE_MODULES = (
    "sparse_mocap.capture.client",
    "sparse_mocap.capture.drivers",
    "sparse_mocap.capture.ports",
    "sparse_mocap.capture.recording",
    "sparse_mocap.capture",
)


def core() -> ModuleType:
    """The package; raises InputError with one line for the animator when it is missing."""
    module, reason = _found()
    if module is None:
        raise InputError(reason)
    return module


def missing_reason() -> str:
    """Why the package cannot be used and what to do; empty when it can."""
    return _found()[1]


@cache
def _found() -> tuple[ModuleType | None, str]:
    try:
        return _imported(), ""
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "sparse_mocap":
            return (
                None,
                f"The Python package {error.name} is missing: install it in Blender's Python",
            )
        return None, _not_there(error.name or "")
    except Exception as error:  # the panel shows whatever a broken installation raises
        return None, f"Sparse Mocap cannot be loaded, reinstall the add-on: {one_line(error)}"


def capture() -> ModuleType:
    """The package's part for real sensors; raises InputError when it cannot be used."""
    core()
    try:
        return _with_vendor(CAPTURE_MODULES)
    except ImportError as error:
        raise InputError(
            f"Real sensors need the Python package {error.name}: install it in Blender's Python"
        ) from error


def _imported() -> ModuleType:
    """The package, with all its modules that the add-on uses."""
    _with_vendor(MODULES)
    return sys.modules["sparse_mocap"]


def _with_vendor(names: tuple[str, ...]) -> ModuleType:
    """Imports modules, some of which may be in the vendor folder, and returns the last."""
    where = str(VENDOR)
    if VENDOR.is_dir():
        sys.path.insert(0, where)
    try:
        return [importlib.import_module(name) for name in names][-1]
    finally:
        if where in sys.path:
            sys.path.remove(where)


def _not_there(name: str) -> str:
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    if name == "sparse_mocap":
        return "The add-on is incomplete, its core is missing: install it from the release file"
    return (
        f"This release of the add-on does not support Blender's Python {python}: "
        "install the release for this Blender version"
    )
