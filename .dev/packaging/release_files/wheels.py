# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels of the package: a zip with a list of its files, so none but this is needed to make one."""

import base64
import csv
import hashlib
import io
from collections.abc import Iterator
from typing import Any

from .archives import Files, under
from .project import Project

PACKAGE = "sparse_mocap"


def wheel_name(project: Project, tag: str) -> str:
    """The name of a wheel for a tag such as ``cp311-cp311-win_amd64``."""
    return f"{PACKAGE}-{project.version}-{tag}.whl"


def wheel_files(project: Project, modules: Files, tag: str) -> dict[str, bytes]:
    """What a wheel with these compiled modules holds, its RECORD included."""
    info = f"{PACKAGE}-{project.version}.dist-info"
    files = {
        **package_files(project, modules),
        **under(f"{info}/licenses", project.licences),
        f"{info}/METADATA": metadata(project),
        f"{info}/WHEEL": _wheel(tag),
        f"{info}/entry_points.txt": _entry_points(project.settings),
    }
    files[f"{info}/RECORD"] = record(files, f"{info}/RECORD")
    return files


def package_files(project: Project, modules: Files) -> dict[str, bytes]:
    """The package with compiled modules, and their names, which tell when one is removed later."""
    names = _text(sorted(modules))
    return under(PACKAGE, {**project.package, **modules, "compiled_modules.txt": names})


def metadata(project: Project) -> bytes:
    """The description of the package, in a wheel and in a source archive."""
    settings = project.settings
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {settings['name']}",
        f"Version: {project.version}",
        f"Summary: {settings['description']}",
        f"License-Expression: {settings['license']}",
        *(f"License-File: {name}" for name in sorted(project.licences)),
        f"Requires-Python: {settings['requires-python']}",
        *(f"Requires-Dist: {name}" for name in settings["dependencies"]),
        *_extras(settings.get("optional-dependencies", {})),
    ]
    return _text(lines)


def record(files: Files, own_name: str) -> bytes:
    """The list of a wheel's files with their hashes; it names itself without one."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    for name in sorted(files):
        writer.writerow((name, f"sha256={record_hash(files[name])}", len(files[name])))
    writer.writerow((own_name, "", ""))
    return buffer.getvalue().encode()


def record_hash(data: bytes) -> str:
    """A SHA-256 as RECORD writes it."""
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def _extras(extras: dict[str, list[str]]) -> Iterator[str]:
    for extra, names in sorted(extras.items()):
        yield f"Provides-Extra: {extra}"
        for name in names:
            yield f"Requires-Dist: {name}; extra == '{extra}'"


def _wheel(tag: str) -> bytes:
    return _text(
        [
            "Wheel-Version: 1.0",
            "Generator: sparse-mocap",
            "Root-Is-Purelib: false",
            f"Tag: {tag}",
        ]
    )


def _entry_points(settings: dict[str, Any]) -> bytes:
    scripts = [f"{name} = {target}" for name, target in settings["scripts"].items()]
    return _text(["[console_scripts]", *scripts])


def _text(lines: list[str]) -> bytes:
    return ("\n".join(lines) + "\n").encode()
