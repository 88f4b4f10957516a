# SPDX-License-Identifier: GPL-3.0-or-later
"""What compiled modules must be like before `./dev package` hands them out."""

from __future__ import annotations

import dataclasses
import hashlib
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from made_modules import (
    ENTRY,
    MODULE_311,
    MODULE_313,
    WINDOWS_311,
    WINDOWS_313,
    compiled,
    small_modules,
    windows_module,
)
from release_files import archives, checks, elf, pe
from release_files.errors import PackagingError

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def modules(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return small_modules(tmp_path_factory.mktemp("modules"))


def test_a_module_that_is_as_it_must_be_passes(modules: dict[str, bytes]) -> None:
    found = checks.checked_module(MODULE_311, modules[MODULE_311], ["/home/builder"])
    assert dataclasses.asdict(found) == {
        "name": MODULE_311,
        "size": len(modules[MODULE_311]),
        "sha256": hashlib.sha256(modules[MODULE_311]).hexdigest(),
        "system": "glibc 0",
        "exported": ("PyInit__core",),
        "needed": (),
    }


@pytest.mark.parametrize(
    ("text", "options", "fault"),
    [
        (ENTRY % 1 + "int other;\n", ["-nostdlib"], "it exports PyInit__core, other, which must"),
        ("int other;\n", ["-nostdlib"], "it exports other, which must be PyInit__core alone"),
        (ENTRY % 1, ["-nostdlib", "-Wl,-rpath,/opt"], "it tells the loader where to look"),
        (
            "int lost(void); int PyLong_Type(void);\n"
            "int PyInit__core(void) { return lost() + PyLong_Type(); }\n",
            ["-nostdlib"],
            "it needs lost, which nothing it links has",
        ),
        (
            ENTRY % 1,
            ["-nostdlib", "-Wl,--no-as-needed", "-lstdc++"],
            r"it needs libstdc\+\+\.so\.6",
        ),
        (
            'const char *PyInit__core = "/home/me/x.c";',
            ["-nostdlib"],
            "name of the folder /home/me",
        ),
        (
            "int __libc_single_threaded_x; extern char __libc_single_threaded;\n"
            "int PyInit__core(void) { return __libc_single_threaded; }\n",
            ["-Wl,--version-script=exports.map"],
            r"it needs GLIBC_2\.32, newer than glibc 2\.28",
        ),
    ],
)
def test_a_module_that_others_cannot_use_is_refused(
    tmp_path: Path, text: str, options: list[str], fault: str
) -> None:
    shutil.copy(ROOT / "bindings" / "exports.map", tmp_path)
    with pytest.raises(PackagingError, match=f"^{MODULE_311}: .*{fault}"):
        checks.checked_module(MODULE_311, compiled(tmp_path, text, *options), ["/home/me"])


def test_the_reader_of_libraries_agrees_with_readelf() -> None:
    """On libraries of this machine, found among what this Python has loaded."""
    lines = Path("/proc/self/maps").read_text().splitlines()
    libraries = {line.split()[-1] for line in lines if ".so" in line.split()[-1]}
    system = sorted(path for path in libraries if path.startswith(("/usr/lib", "/lib")))
    assert system
    for path in system[:5]:
        run = subprocess.run(
            ["readelf", "-dW", "-V", "--dyn-syms", path], capture_output=True, text=True, check=True
        )
        library = elf.read_library(Path(path).read_bytes())
        needed = [line.split("[")[1][:-1] for line in run.stdout.splitlines() if "(NEEDED)" in line]
        assert list(library.needed) == needed
        exported = readelf_exports(run.stdout)
        assert sorted(library.exported) == sorted(exported)
        for version in library.versions:
            assert f"Name: {version} " in run.stdout


def readelf_exports(text: str) -> list[str]:
    names = []
    for line in text.splitlines():
        columns = line.split()
        if len(columns) < 8 or not columns[0].endswith(":") or columns[6] == "UND":
            continue
        if columns[4] in ("GLOBAL", "WEAK", "UNIQUE"):
            names.append(columns[7].split("@")[0])
    return names


@pytest.mark.parametrize("length", [0, 5, 64, 200, 5000])
def test_a_damaged_module_is_refused(modules: dict[str, bytes], length: int) -> None:
    with pytest.raises(PackagingError, match=r"is (not|a damaged)"):
        checks.checked_module(MODULE_311, modules[MODULE_311][:length])


def test_a_module_of_another_name_is_refused(modules: dict[str, bytes]) -> None:
    with pytest.raises(PackagingError, match=r"_core\.so is not called as CPython"):
        checks.checked_module("_core.so", modules[MODULE_311])


# --- Windows -------------------------------------------------------------------------------------


def test_a_windows_module_that_is_as_it_must_be_passes() -> None:
    module = windows_module("python311.dll")
    found = checks.checked_module(WINDOWS_311, module, ["/home/builder"])
    assert found.exported == ("PyInit__core",)
    assert found.needed == ("KERNEL32.dll", "msvcrt.dll", "python311.dll")
    assert found.system == "Windows"
    assert found.sha256 == hashlib.sha256(module).hexdigest()


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"exported": ("PyInit__core", "other")}, "it exports PyInit__core, other, which must"),
        ({"exported": ()}, "it exports nothing, which must be PyInit__core alone"),
        ({"more": ("libstdc++-6.dll",)}, r"it needs libstdc\+\+-6\.dll, which other machines"),
        ({"python": "python313.dll"}, r"it does not need python311\.dll, which its name promises"),
        ({"machine": 0xAA64}, "it is for another processor than x86-64"),
        ({"linked_at_s": 1_700_000_000}, "it holds the time at which it was linked"),
        ({"num_symbols": 3}, "it still holds the symbols of the linker"),
        ({"text": b"/home/me/x.cpp"}, "it holds the name of the folder /home/me"),
    ],
)
def test_a_windows_module_that_others_cannot_use_is_refused(
    changes: dict[str, Any], fault: str
) -> None:
    module = windows_module(**{"python": "python311.dll", **changes})
    with pytest.raises(PackagingError, match=f"^{re.escape(WINDOWS_311)}: .*{fault}"):
        checks.checked_module(WINDOWS_311, module, ["/home/me"])


def test_the_reader_of_windows_libraries_agrees_with_objdump(tmp_path: Path) -> None:
    made = tmp_path / "made.pyd"
    made.write_bytes(windows_module("python313.dll", exported=("PyInit__core", "other")))
    library = pe.read_library(made.read_bytes())
    run = subprocess.run(["objdump", "-p", made], capture_output=True, text=True, check=True)
    assert list(library.needed) == re.findall(r"DLL Name: (\S+)", run.stdout)
    names = run.stdout.partition("[Ordinal/Name Pointer] Table")[2]
    assert list(library.exported) == re.findall(r"\] (?:[0-9a-f]{4} )?(\w+)$", names, re.MULTILINE)
    assert library.exported == ("PyInit__core", "other")


@pytest.mark.parametrize("length", [0, 5, 63, 100, 300, 700])
def test_a_damaged_windows_module_is_refused(length: int) -> None:
    with pytest.raises(PackagingError, match=r"is (not|a damaged)"):
        checks.checked_module(WINDOWS_313, windows_module("python313.dll")[:length])


def test_an_archive_with_another_module_is_refused(modules: dict[str, bytes]) -> None:
    checked = [checks.checked_module(name, data) for name, data in modules.items()]
    swapped = {f"sparse_mocap/{MODULE_311}": modules[MODULE_313]}
    inside = archives.zipped({"wheels/a.whl": archives.zipped(swapped)})
    with pytest.raises(PackagingError, match=f"a.zip holds another {MODULE_311}"):
        checks.check_same_modules(checked, {"a.zip": inside})
    with pytest.raises(PackagingError, match=r"a\.zip holds no compiled module"):
        checks.check_same_modules(checked, {"a.zip": archives.zipped({"a.py": b""})})
