# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the package ``sparse_mocap``, installed or in the add-on's ``vendor`` folder."""

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType

from . import installation, installation_paths
from .errors import InputError, log
from .installation import Problem

ADDON = Path(__file__).resolve().parents[1]
VENDOR = ADDON / "vendor"
MODULES = (
    "sparse_mocap._core",
    "sparse_mocap.calibration_file",
    "sparse_mocap.databases",
    "sparse_mocap.mappings",
    "sparse_mocap.methods",
    "sparse_mocap.pose_calibration",
    "sparse_mocap.readings",
    "sparse_mocap.reconstruction",
    "sparse_mocap.quality",
    "sparse_mocap.report",
    "sparse_mocap.take",
    "sparse_mocap.training",
)
CAPTURE_MODULES = (
    "sparse_mocap.capture.client",
    "sparse_mocap.capture.diagnosis",
    "sparse_mocap.capture.driver_guide",
    "sparse_mocap.capture.drivers",
    "sparse_mocap.capture.ports",
    "sparse_mocap.capture.recording",
    "sparse_mocap.capture.remembered_sites",
    "sparse_mocap.capture.shaking",
    "sparse_mocap.capture",
)


def core() -> ModuleType:
    """The package; raises InputError with one line for the animator when it is missing."""
    module, found = _found()
    if module is None:
        raise InputError(found.reason if found else "")
    return module


def missing_reason() -> str:
    """Why the package cannot be used and what to do; empty when it can."""
    found = problem()
    return found.reason if found else ""


def problem() -> Problem | None:
    """Why the package cannot be used, with what Python raised; None when it can."""
    return _found()[1]


@cache
def _found() -> tuple[ModuleType | None, Problem | None]:
    is_from_before = "sparse_mocap._core" in sys.modules
    found = _numpy_problem() or _conflict(is_from_before)
    if found is None:
        try:
            module = _imported()
        except Exception as error:  # the panel shows whatever a broken installation raises
            log.debug("the core cannot be imported", exc_info=error)
            return None, _conflict(is_from_before) or installation.import_problem(
                error, installation.this_host(), _package_folder()
            )
        found = _conflict(is_from_before)
        if found is None:
            return module, None
    return None, found


def capture() -> ModuleType:
    """The package's part for real sensors; raises InputError when it cannot be used."""
    core()
    try:
        return _imported_all(CAPTURE_MODULES)
    except ImportError as error:
        raise InputError(
            f"Real sensors need the Python package {error.name}: install it in Blender's Python"
        ) from error


def training_module() -> ModuleType:
    """The package's part that chooses what models are trained from."""
    core()
    return _imported_all(("sparse_mocap.training",))


def latent_space_module() -> ModuleType:
    """The package's part that lays out what a model has learned."""
    core()
    return _imported_all(("sparse_mocap.latent_space",))


def imports_module() -> ModuleType:
    """The package's part that reads recordings of other programs."""
    core()
    return _imported_all(("sparse_mocap.imports",))


def demo_motions() -> ModuleType:
    """The package's generator of movements; raises InputError when it cannot be used."""
    core()
    return _imported_all(("sparse_mocap.demo_motions",))


def searched_folders() -> list[Path]:
    """The folders in which the package that belongs to this add-on may be."""
    is_extension = __name__.startswith("bl_ext.")
    folders = installation_paths.own_folders(ADDON, is_extension=is_extension)
    return [VENDOR if folder == ADDON / "vendor" else folder for folder in folders]


def _imported() -> ModuleType:
    """The package, with all its modules that the add-on uses."""
    importlib.invalidate_caches()
    _imported_all(MODULES)
    return sys.modules["sparse_mocap"]


def _imported_all(names: tuple[str, ...]) -> ModuleType:
    """Imports modules, some of which may be in the vendor folder, and returns the last."""
    with _own_folder_first():
        return [importlib.import_module(name) for name in names][-1]


@contextmanager
def _own_folder_first() -> Iterator[None]:
    """Python looks for modules first in the folder that was installed with the add-on."""
    own = installation_paths.own_package(searched_folders())
    where = str(own.parent if own is not None else VENDOR)
    is_there = Path(where).is_dir()
    if is_there:
        sys.path.insert(0, where)
    try:
        yield
    finally:
        if is_there and where in sys.path:
            sys.path.remove(where)


def _numpy_problem() -> Problem | None:
    """Why NumPy does not suffice."""
    try:
        import numpy
    except ImportError as error:
        return installation.numpy_problem(error)
    return installation.numpy_problem(numpy)


def _conflict(is_from_before: bool) -> Problem | None:
    """Why the package that is loaded, if one is, is not the one that belongs to the add-on."""
    package = sys.modules.get("sparse_mocap")
    if package is None:
        return None
    if getattr(package, "__file__", None) is None:
        return installation.no_init_problem()
    compiled = sys.modules.get("sparse_mocap._core")
    place = Path(str(package.__file__)).parent
    if place.resolve() == ADDON:
        return installation.folder_name_problem()
    version = getattr(compiled, "__version__", "")
    return installation.conflict(
        (place, version or installation_paths.package_version(place)),
        installation_paths.own_package(searched_folders()),
        (ADDON, installation_paths.addon_version(ADDON)),
        is_from_before=is_from_before,
    )


def _package_folder() -> Path | None:
    """The folder of the package that is imported, or else of the one that was installed."""
    file = getattr(sys.modules.get("sparse_mocap"), "__file__", None)
    if file is not None:
        return Path(file).parent
    return installation_paths.own_package(searched_folders())
