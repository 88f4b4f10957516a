# SPDX-License-Identifier: GPL-3.0-or-later
"""The two forms of the add-on: an extension since Blender 4.2, and a plain add-on before."""

import tomllib
from collections.abc import Sequence

from .archives import Files, under, unzipped
from .errors import PackagingError
from .project import Project
from .wheels import package_files

LEGACY_FOLDER = "sparse_mocap_addon"
"""Blender puts the folder of add-ons on the module path: one called ``sparse_mocap`` would hide the
package of that name, which the add-on needs."""


def extension_files(project: Project, wheels: Files, platforms: Sequence[str]) -> dict[str, bytes]:
    """What the extension holds: the add-on, its manifest, and the wheels that Blender installs."""
    return {
        **project.addon,
        **project.licences,
        **under("wheels", wheels),
        "blender_manifest.toml": manifest(project.manifest, sorted(wheels), platforms).encode(),
    }


def manifest(text: str, wheels: Sequence[str], platforms: Sequence[str]) -> str:
    """The manifest with the platforms and wheels of this release; PackagingError if it has some."""
    keys = tomllib.loads(text)
    if present := sorted({"platforms", "wheels"} & keys.keys()):
        raise PackagingError(f"the manifest already has {present}: packaging fills these in")
    first_table = text.index("\n[") + 1  # a key after it would belong to that table
    systems = ", ".join(f'"{name}"' for name in platforms)
    listed = "".join(f'  "./wheels/{name}",\n' for name in wheels)
    filled = f"platforms = [{systems}]\nwheels = [\n{listed}]\n\n"
    return text[:first_table] + filled + text[first_table:]


def legacy_files(project: Project, modules: Files, pyserial: bytes) -> dict[str, bytes]:
    """What the plain add-on holds: everything in one folder, packages of others in ``vendor``."""
    serial = {name: data for name, data in unzipped(pyserial).items() if name.startswith("serial/")}
    if not serial:
        raise PackagingError("the wheel of pyserial holds no package serial")
    vendor = under("vendor", {**package_files(project, modules), **serial})
    files = {**project.addon, **project.licences, **vendor}
    return under(LEGACY_FOLDER, files)
