# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on under test: as animators install it, or as the sources are.

SPARSE_MOCAP_PACKAGE names the release file that is tested; without it the sources are. Import this
module before bpy: it gives Blender user folders of its own.
"""

from __future__ import annotations

import atexit
import importlib
import os
import shutil
import sys
import tempfile
import zipfile
from pathlib import Path
from types import ModuleType

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PACKAGE = os.environ.get("SPARSE_MOCAP_PACKAGE", "")
_FOLDERS = ("BLENDER_USER_RESOURCES", "BLENDER_USER_SCRIPTS", "BLENDER_USER_CONFIG")


def _module_name() -> str:
    if not PACKAGE:
        return "blender_addon"
    with zipfile.ZipFile(PACKAGE) as archive:
        names = archive.namelist()
    if "blender_manifest.toml" in names:
        return "bl_ext.user_default.sparse_mocap"
    return names[0].partition("/")[0]  # add-ons of old have one folder


ADDON = _module_name()
IS_EXTENSION = ADDON.startswith("bl_ext.")


def prepare_paths() -> None:
    """Lets tests and their helpers be imported, and the sources if no package is tested."""
    sys.path[:0] = [str(HERE), str(HERE.parent)]
    if not PACKAGE:
        sys.path.insert(0, str(ROOT))
        sys.path.append(str(ROOT / "bindings"))  # unless PYTHONPATH names another one
        return
    if _FOLDERS[0] not in os.environ:
        if "bpy" in sys.modules:
            raise SystemExit(f"set {', '.join(_FOLDERS)}: Blender has read them already")
        folder = _temporary("sparse_mocap_user_")
        os.environ |= dict.fromkeys(_FOLDERS, str(folder))


def install(path: str | Path = PACKAGE) -> None:
    """Installs a release file as Blender's preferences do."""
    import bpy

    if IS_EXTENSION:
        bpy.ops.extensions.package_install_files(
            filepath=str(path), repo="user_default", enable_on_install=False, overwrite=True
        )
    elif path:
        bpy.ops.preferences.addon_install(filepath=str(path), overwrite=True)


def remove() -> None:
    """Removes what was installed, as Blender's preferences do."""
    import bpy

    if IS_EXTENSION:
        repos = [repo.module for repo in bpy.context.preferences.extensions.repos]
        index, name = repos.index("user_default"), ADDON.rpartition(".")[2]
        bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id=name)
        return
    window = bpy.context.window_manager.windows[0]  # the operator redraws the area it is called in
    with bpy.context.temp_override(window=window, area=window.screen.areas[0]):
        bpy.ops.preferences.addon_remove(module=ADDON)


def register() -> None:
    """Enables the add-on."""
    if not PACKAGE:
        importlib.import_module(ADDON).register()
        return
    import addon_utils

    enabled = addon_utils.enable(ADDON, default_set=True)
    assert enabled is not None, "the add-on cannot be enabled"


def unregister() -> None:
    """Disables it."""
    if not PACKAGE:
        importlib.import_module(ADDON).unregister()
        return
    import addon_utils

    addon_utils.disable(ADDON, default_set=True)


def module(name: str = "") -> ModuleType:
    """A module of the add-on as it is registered now."""
    return importlib.import_module(f"{ADDON}.{name}" if name else ADDON)


def _temporary(prefix: str) -> Path:
    folder = Path(tempfile.mkdtemp(prefix=prefix))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder
