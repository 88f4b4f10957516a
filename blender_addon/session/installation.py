# SPDX-License-Identifier: GPL-3.0-or-later
"""Why an installation cannot work, and what to do, in one line; needs no bpy and no NumPy."""

from __future__ import annotations

import importlib.machinery
import platform
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from .installation_paths import PACKAGE, home_hidden

OLDEST_NUMPY = (1, 24)  # the oldest that the tests run with
BLENDERS = {
    "3.11": "Blender 4.1 to 5.0 and Debian's 3.4",
    "3.13": "Blender 5.1 and later",
    "3.14": "Debian unstable's Blender 5.2",
}
"""The Blenders of each CPython that a compiled module may be for."""

RELEASED = "compiled_modules.txt"
"""The file beside the compiled modules that lists them, one a line."""

_REINSTALL = "reinstall the add-on from the release file"
_SYSTEMS = {"musl": "Linux with musl", "linux": "Linux", "darwin": "macOS", "win": "Windows"}
_MODULE = re.compile(r"_core\.(?:cpython-|cp)(\d)(\d+t?)(?:-([\w-]+))?\.(?:so|pyd)$")
_WRONG_MACHINE = re.compile(
    r"wrong ELF class|(?:incompatible|wrong) architecture|not a valid Win32 application", re.I
)
_DAMAGED = re.compile(
    r"file too short|invalid ELF header|not a mach-o|truncated|cannot read file data", re.I
)
_TOO_OLD = re.compile(
    r"version [`'\"].*not found|(?:symbol not found|undefined symbol):? (?!_*Py)|"
    r"built for (?:a )?newer|procedure could not be found",
    re.I,
)
_NO_LIBRARY = re.compile(
    r"cannot open shared object|library not loaded|module could not be found", re.I
)


@dataclass(frozen=True)
class Problem:
    """Why the add-on cannot work."""

    reason: str  # one line: what is wrong and what to do
    error: BaseException | None = None  # what Python raised


@dataclass(frozen=True)
class Target:
    """What a compiled module is for, or what this Python is."""

    python: str  # such as 3.11
    system: str  # Linux, Windows or macOS; empty: not known
    machine: str  # x86-64, ARM, 32-bit; empty: any, or not known

    @property
    def place(self) -> str:
        """System and machine in words."""
        return f"{self.system} ({self.machine})" if self.machine else self.system


@dataclass(frozen=True)
class Host:
    """The Python that the add-on runs in."""

    target: Target
    blender: str = ""  # its version, if this is a Blender

    @property
    def name(self) -> str:
        """What a sentence calls it."""
        return f"this Blender {self.blender}".strip()


def this_host() -> Host:
    """The Python that runs this, and the Blender around it."""
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    named = target_of(f"_core{importlib.machinery.EXTENSION_SUFFIXES[0]}")
    system = named.system if named else _system(platform.system())
    machine = (named.machine if named else "") or _machine(platform.machine())
    if sys.maxsize < 2**32:
        machine = "32-bit"
    app = getattr(sys.modules.get("bpy"), "app", None)
    version = getattr(app, "version_string", "")
    return Host(Target(named.python if named else python, system, machine), version)


def target_of(name: str) -> Target | None:
    """What the compiled module with that file name is for; None for any other name."""
    found = _MODULE.fullmatch(name)
    if found is None:
        return None
    tag = found[3] or ""
    return Target(f"{found[1]}.{found[2]}", _system(tag), _machine(tag))


def compiled_modules(package: Path) -> list[str]:
    """The names of the compiled modules in the package's folder."""
    names = (path.name for path in package.glob("_core.*") if path.suffix in (".so", ".pyd"))
    return sorted(names)


def released_modules(package: Path) -> list[str]:
    """The names of the compiled modules that the release put there; empty when it does not tell."""
    try:
        return (package / RELEASED).read_text(encoding="utf-8").split()
    except OSError:
        return []


def import_problem(error: BaseException, host: Host, package: Path | None) -> Problem:
    """Why the package's modules could not be imported.

    package: the folder of the package that was imported from; None: there is none.
    """
    name = getattr(error, "name", None) or ""
    if isinstance(error, ModuleNotFoundError):
        if name.split(".")[0] != PACKAGE:
            reason = f"The Python package {name} is missing: install it in Blender's Python"
        elif name == f"{PACKAGE}._core" and package is not None:
            reason = _no_module(host, package)
        else:
            reason = _incomplete(f"{name.replace('.', '/')} is missing")
    elif isinstance(error, ImportError) and (name == f"{PACKAGE}._core" or name == "_core"):
        reason = _not_loaded(error, host)
    elif isinstance(error, ImportError | SyntaxError | EOFError):
        reason = _incomplete(_short(error))
    else:
        reason = f"Sparse Mocap cannot be loaded, {_REINSTALL}: {_short(error)}"
    return Problem(reason, error)


def addon_problem(error: BaseException) -> Problem:
    """Why the add-on's own files could not be imported."""
    return Problem(_incomplete(_short(error)), error)


def folder_name_problem() -> Problem:
    """The add-on's folder has the name of the package, which therefore cannot be imported."""
    return Problem(f"The add-on's folder must not be named {PACKAGE}: {_REINSTALL}")


def no_init_problem() -> Problem:
    """The package's folder is there without the file that makes it a package."""
    return Problem(_incomplete(f"{PACKAGE}/__init__.py is missing"))


def numpy_problem(numpy: ModuleType | ImportError) -> Problem | None:
    """Why NumPy, or what its import raised, does not suffice; None when it does."""
    oldest = ".".join(map(str, OLDEST_NUMPY))
    get = (
        f"install NumPy {oldest} or later in Blender's Python (on Debian: python3-numpy), "
        "or use a Blender from blender.org"
    )
    if isinstance(numpy, ModuleNotFoundError) and (numpy.name or "").startswith("numpy"):
        return Problem(f"This Blender's Python has no NumPy: {get}", numpy)
    if isinstance(numpy, ImportError):
        return Problem(f"This Blender's NumPy cannot be loaded ({_short(numpy)}): {get}", numpy)
    version = str(getattr(numpy, "__version__", ""))
    numbers = _numbers(version)
    if not numbers or numbers[:2] >= OLDEST_NUMPY:
        return None
    where = home_hidden(str(Path(numpy.__file__ or "").parent))
    return Problem(f"NumPy {version} in {where} is too old: {get}")


def conflict(
    loaded: tuple[Path, str], own: Path | None, addon: tuple[Path, str], *, is_from_before: bool
) -> Problem | None:
    """Why the imported package is not the one that belongs to the add-on; None when it is.

    loaded, addon: folder and version. The version is empty when it is not known.
    own: the package that was installed with the add-on, if there is one.
    is_from_before: whether it was imported before the add-on was enabled.
    """
    (place, version), (addon_place, addon_version) = loaded, addon
    differs = (
        bool(version and addon_version) and _numbers(version)[:3] != _numbers(addon_version)[:3]
    )
    is_elsewhere = own is not None and place.resolve() != own.resolve()
    other = f"{version or 'another version'} in {home_hidden(str(place))}"
    if is_elsewhere and place.is_dir():
        ours = f"{addon_version} in {home_hidden(str(own))}"
        return Problem(
            f"Sparse Mocap is installed twice, {ours} and {other}: "
            "remove the one that you do not need, and restart Blender"
        )
    if is_elsewhere or (differs and own is not None and is_from_before):
        return Problem(
            f"Sparse Mocap {addon_version} was installed while {version or 'another version'} "
            "was loaded: restart Blender"
        )
    if differs and own is not None:
        return Problem(
            f"Files of Sparse Mocap {addon_version} and {version} are mixed: "
            f"restart Blender; if this stays, {_REINSTALL}"
        )
    if differs:
        ours = f"the add-on {addon_version} in {home_hidden(str(addon_place))}"
        return Problem(
            f"Two versions of Sparse Mocap are installed, {ours} and the Python package {other}: "
            f"remove the package, {_REINSTALL}, and restart Blender"
        )
    return None


def one_python_line(error: BaseException) -> str:
    """What Python raised, as one line."""
    return home_hidden(f"{type(error).__name__}: {' '.join(str(error).split())}")


def _no_module(host: Host, package: Path) -> str:
    """No compiled module has a name that this Python looks for."""
    if host.target.machine == "32-bit":
        return "Sparse Mocap needs a 64-bit Blender and this one is 32-bit: install a 64-bit one"
    names = {*compiled_modules(package), *released_modules(package)}
    targets = [target for name in names if (target := target_of(name))]
    here = [target for target in targets if _fits(target, host.target)]
    if here and all(target.python != host.target.python for target in here):
        return _other_python(host, {target.python for target in here})
    if targets and not here:
        return _other_machine(sorted({target.place for target in targets}), host)
    return (
        f"The compiled file _core is missing in {home_hidden(str(package))}, an antivirus may have "
        f"removed it: allow it there and {_REINSTALL}"
    )


def _other_python(host: Host, pythons: Iterable[str]) -> str:
    ordered = sorted(pythons, key=_numbers)
    known = _listed(f"{python} ({BLENDERS[python]})" if python in BLENDERS else python
                    for python in ordered)  # fmt: skip
    fitting = BLENDERS.get(host.target.python)
    install = f"the release for {fitting}" if fitting else "one of these Blenders"
    return (
        f"This release of Sparse Mocap does not work with Python {host.target.python} of "
        f"{host.name}, only with Python {known}: install {install}"
    )


def _other_machine(places: list[str], host: Host) -> str:
    return (
        f"This release of Sparse Mocap is for {_listed(places)} and {host.name} is for "
        f"{host.target.place}: install the release for {host.target.place}, if there is one"
    )


def _not_loaded(error: ImportError, host: Host) -> str:
    """The compiled module is there and the system's loader refuses it."""
    said = _short(error)
    if _WRONG_MACHINE.search(said):
        return (
            f"This release of Sparse Mocap is for another processor than {host.target.place} "
            f"({said}): install the release for {host.target.place}, if there is one"
        )
    if _DAMAGED.search(said):
        return _incomplete(said)
    if _TOO_OLD.search(said):
        return (
            f"This system is too old for this release of Sparse Mocap ({said}): update the system"
        )
    if _NO_LIBRARY.search(said):
        is_windows = host.target.system == "Windows"
        library = "the Microsoft Visual C++ Redistributable" if is_windows else "it"
        return f"Sparse Mocap needs a library of the system ({said}): install {library}"
    return f"The compiled part of Sparse Mocap cannot be loaded ({said}): {_REINSTALL}"


def _incomplete(what: str) -> str:
    return f"The installation is incomplete ({what}): {_REINSTALL}"


def _short(error: BaseException) -> str:
    """What the error says, with the folders of files left out."""
    text = " ".join(str(error).split())
    text = re.sub(
        r"(?<![\w.~-])(?:[A-Za-z]:)?[\\/](?:[^\\/:'\"()]+[\\/])+(?=[^\\/:'\"()\s])", "", text
    )
    return home_hidden(text) or type(error).__name__


def _fits(target: Target, host: Target) -> bool:
    """Whether the module is for this system and machine, where its name tells."""
    return target.system in ("", host.system) and target.machine in ("", host.machine)


def _system(tag: str) -> str:
    """The system in words, of a platform tag or of what the system calls itself."""
    return next((text for key, text in _SYSTEMS.items() if key in tag.lower()), "")


def _machine(tag: str) -> str:
    """The machine in words, of a platform tag or of what the system calls it."""
    tag = tag.lower()
    if "aarch64" in tag or "arm64" in tag:
        return "ARM"
    if "x86_64" in tag or "amd64" in tag:
        return "x86-64"
    if re.search(r"i[3-6]86|win32|\barm", tag):
        return "32-bit"
    return ""


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, re.findall(r"\d+", version)))


def _listed(words: Iterable[str]) -> str:
    """The words as a list that ends in "and"."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last
