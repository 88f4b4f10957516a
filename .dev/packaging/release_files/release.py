# SPDX-License-Identifier: GPL-3.0-or-later
"""All files of a release, made in one go, checked, and reported."""

import dataclasses
import hashlib
import json
import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from .addons import extension_files, legacy_files
from .archives import Files, tarred, unzipped, zipped
from .checks import (
    CheckedModule,
    check_record,
    check_same_modules,
    checked_module,
    modules_in,
)
from .errors import PackagingError
from .project import Project, read_project
from .sdist import sdist_files, sdist_name
from .targets import Target, target_of, targets_of
from .wheels import wheel_files, wheel_name

LEGACY_PYTHON = "cp311"
"""The CPython of the Blenders before 4.2 that the plain add-on is for."""


@dataclass(frozen=True)
class Made:
    """One file of the release."""

    data: bytes
    seconds: float

    @property
    def sha256(self) -> str:
        """Its hash, as SHA256SUMS gives it."""
        return hashlib.sha256(self.data).hexdigest()


@dataclass
class Release:
    """The files by their names, and what the checks found."""

    version: str
    modules: list[CheckedModule]
    files: dict[str, Made] = field(default_factory=dict)
    checks: list[str] = field(default_factory=list)
    headers: dict[str, str] = field(default_factory=dict)
    """The exact version of the headers by which the modules were compiled, such as 3.14.8, and
    their hash."""

    def add(self, name: str, make: Callable[[], bytes]) -> bytes:
        """Make a file, and remember it and how long it took."""
        start = time.perf_counter()
        data = make()
        self.files[name] = Made(data, time.perf_counter() - start)
        return data


def make_release(root: Path, modules: Files, pyserial: tuple[str, bytes]) -> Release:
    """Make and check everything; PackagingError when something must not be handed out.

    ``modules`` are the compiled modules by their file names, ``pyserial`` the name and content of
    its wheel.
    """
    project = read_project(root)
    private = (f"{root}/", f"{Path.home()}/")
    release = Release(
        project.version,
        [checked_module(name, data, private) for name, data in sorted(modules.items())],
    )
    _add_wheels(release, project, modules)
    release.add(f"{_stem(project)}.zip", lambda: _extension(project, modules, pyserial))
    for target in targets_of(modules):
        _add_legacy(release, project, _modules_of(target, modules), pyserial)
    release.add(f"{sdist_name(project)}.tar.gz", lambda: tarred(sdist_files(root, project)))
    _check(release)
    return release


def _add_wheels(release: Release, project: Project, modules: Files) -> None:
    """The wheel of each CPython, for pip."""
    for name, data in sorted(modules.items()):
        target, python = target_of(name)
        tag = f"{python}-{python}-{target.wheel}"
        files = wheel_files(project, {name: data}, tag)
        release.add(wheel_name(project, tag), partial(zipped, files))


def _add_legacy(
    release: Release, project: Project, modules: Files, pyserial: tuple[str, bytes]
) -> None:
    """The plain add-on for one system."""
    (target,) = targets_of(modules)
    legacy = {n: data for n, data in modules.items() if target_of(n)[1] == LEGACY_PYTHON}
    if not legacy:
        raise PackagingError(f"no module for {LEGACY_PYTHON} on {target.words} was built")
    files = legacy_files(project, legacy, pyserial[1])
    release.add(f"{_stem(project)}-legacy-{target.blender}.zip", partial(zipped, files))


def _modules_of(target: Target, modules: Files) -> dict[str, bytes]:
    return {name: data for name, data in modules.items() if target_of(name)[0] == target}


def _stem(project: Project) -> str:
    return f"sparse_mocap-{project.version}"


def _extension(project: Project, modules: Files, pyserial: tuple[str, bytes]) -> bytes:
    """The extension, with one wheel for all modules of a system.

    Blender refuses an extension whose wheels are all for other CPythons. This one it installs
    everywhere: each CPython finds its own module, and where there is none the add-on says so.
    """
    held = dict([pyserial])
    targets = targets_of(modules)
    for target in targets:
        tag = f"py3-none-{target.wheel}"
        files = wheel_files(project, _modules_of(target, modules), tag)
        held[wheel_name(project, tag)] = zipped(files)
    return zipped(extension_files(project, held, [target.blender for target in targets]))


def _check(release: Release) -> None:
    """Read again what was made, as whoever installs it would."""
    zips = {n: made.data for n, made in release.files.items() if n.endswith((".whl", ".zip"))}
    for name, data in sorted(_wheels_in(zips).items()):
        release.checks.append(f"RECORD of {name} is right ({check_record(name, data)} files)")
    check_same_modules(release.modules, zips)
    held = sum(len(modules_in(unzipped(data))) for data in zips.values())
    release.checks.append(
        f"all {held} modules in {len(zips)} wheels and zips are the {len(release.modules)} built"
    )


def _wheels_in(files: Files) -> dict[str, bytes]:
    """The wheels among these files and in the zips among them."""
    found = {}
    for name, data in files.items():
        if name.endswith(".whl"):
            found[name.rpartition("/")[2]] = data
        elif name.endswith(".zip"):
            found |= _wheels_in(unzipped(data))
    return found


def write_release(release: Release, output: Path) -> None:
    """Write the files, their hashes, and a report, in place of what an earlier run left."""
    output.mkdir(parents=True, exist_ok=True)
    for path in output.iterdir():
        if path.is_file():
            path.unlink()
    for name, made in release.files.items():
        (output / name).write_bytes(made.data)
    sums = [f"{made.sha256}  {name}\n" for name, made in sorted(release.files.items())]
    (output / "SHA256SUMS").write_text("".join(sums), encoding="utf-8")
    report = {
        "version": release.version,
        "modules": [dataclasses.asdict(module) for module in release.modules],
        "files": {
            name: {
                "size": len(made.data),
                "sha256": made.sha256,
                "seconds": round(made.seconds, 2),
            }
            for name, made in sorted(release.files.items())
        },
        "headers": release.headers,
        "checks": release.checks,
    }
    (output / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")


def header_versions(folder: Path) -> dict[str, str]:
    """The version and hash of CPython's headers, by the names of the folders that hold them."""
    found = {}
    for path in sorted(folder.glob("*/patchlevel.h")):
        version = re.search(r'#define PY_VERSION\s+"([^"]+)"', path.read_text("utf-8"))
        found[path.parent.name] = f"{version[1] if version else 'unknown'}, {_hash(path.parent)}"
    return found


def _hash(folder: Path) -> str:
    """The hash of the list that sha256sum makes of all files in a folder, sorted by their names."""
    files = {p.relative_to(folder).as_posix(): p for p in folder.rglob("*") if p.is_file()}
    listed = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {name}\n"
        for name, path in sorted(files.items())
    ]
    return f"SHA-256 {hashlib.sha256(''.join(listed).encode()).hexdigest()}"


def table(release: Release) -> Iterator[str]:
    """The report for the terminal, line by line."""
    for module in release.modules:
        yield (
            f"{module.name:<60} {_megabytes(module.size)}  {module.system}, "
            f"exports {' '.join(module.exported)}, needs {' '.join(module.needed)}"
        )
    for name, made in sorted(release.files.items()):
        yield f"{name:<60} {_megabytes(len(made.data))}  {made.seconds:.1f} s"
    for name, version in release.headers.items():
        yield f"headers of CPython for {name}: {version}"
    yield from release.checks


def _megabytes(size: int) -> str:
    return f"{size / 1e6:6.2f} MB"
