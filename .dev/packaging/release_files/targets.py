# SPDX-License-Identifier: GPL-3.0-or-later
"""The systems that there are compiled modules for."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import linux, macos, windows
from .errors import PackagingError
from .examined import Examined


@dataclass(frozen=True)
class Target:
    """A system, under the names that others know it by."""

    words: str
    blender: str
    """In an extension's manifest."""
    wheel: str
    """The last part of a wheel's name."""
    module: str
    """The name under which CPython looks for a module there; ``{}`` is its version, 311."""
    examine: Callable[[bytes, str], Examined]
    """Checks a module for a CPython, such as ``cp311``."""

    def python_tag(self, module: str) -> str | None:
        """Such as ``cp311``, by the name of a module; None when it is for another system."""
        found = re.fullmatch(re.escape(self.module).replace(r"\{\}", r"(3\d+)"), module)
        return f"cp{found[1]}" if found else None


TARGETS = (
    Target(
        words="Linux x86-64",
        blender="linux-x64",
        wheel="manylinux_2_28_x86_64",
        module="_core.cpython-{}-x86_64-linux-gnu.so",
        examine=linux.examine,
    ),
    Target(
        words="Windows x86-64",
        blender="windows-x64",
        wheel="win_amd64",
        module="_core.cp{}-win_amd64.pyd",
        examine=windows.examine,
    ),
    Target(
        words="macOS arm64",
        blender="macos-arm64",
        wheel="macosx_11_0_arm64",
        module="_core.cpython-{}-darwin.so",
        examine=macos.examine,
    ),
)


def target_of(module: str) -> tuple[Target, str]:
    """The system and CPython, such as ``cp311``, of a module, by the name of its file."""
    for target in TARGETS:
        if tag := target.python_tag(module):
            return target, tag
    systems = " or ".join(target.words for target in TARGETS)
    raise PackagingError(f"{module} is not called as CPython on {systems} looks for it")


def is_module(name: str) -> bool:
    """Whether the file of that name, without folders, is a compiled module."""
    return any(target.python_tag(name) for target in TARGETS)


def targets_of(modules: Iterable[str]) -> list[Target]:
    """The systems that these modules are for, in the order of the table."""
    held = {target_of(name)[0] for name in modules}
    return [target for target in TARGETS if target in held]
