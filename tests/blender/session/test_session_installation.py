# SPDX-License-Identifier: GPL-3.0-or-later
import os
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

from blender_addon.session import core, installation, installation_paths
from blender_addon.session.installation import Host, Target, import_problem, target_of
from blender_addon.session.installation_report import report

LINUX = "_core.cpython-{}-x86_64-linux-gnu.so"
REINSTALL = "reinstall the add-on from the release file"
NO_CORE = ModuleNotFoundError("No module named 'sparse_mocap._core'", name="sparse_mocap._core")


def host(python="3.11", system="Linux", machine="x86-64", blender="4.2.1"):
    return Host(Target(python, system, machine), blender)


def package(folder: Path, *modules: str) -> Path:
    made = folder / "sparse_mocap"
    made.mkdir(parents=True)
    for name in ("__init__.py", "_core.pyi", *modules):
        (made / name).touch()
    return made


def not_loaded(text: str) -> ImportError:
    return ImportError(text, name="sparse_mocap._core", path="/x/_core.so")


def is_one_sentence(reason: str) -> bool:
    return "\n" not in reason and len(reason) < 330 and not reason.endswith(".")


@pytest.mark.parametrize(
    ("name", "target"),
    [
        (LINUX.format(311), Target("3.11", "Linux", "x86-64")),
        ("_core.cpython-313t-aarch64-linux-gnu.so", Target("3.13t", "Linux", "ARM")),
        ("_core.cpython-311-i386-linux-gnu.so", Target("3.11", "Linux", "32-bit")),
        ("_core.cpython-311-arm-linux-gnueabihf.so", Target("3.11", "Linux", "32-bit")),
        ("_core.cpython-311-x86_64-linux-musl.so", Target("3.11", "Linux with musl", "x86-64")),
        ("_core.cpython-314-darwin.so", Target("3.14", "macOS", "")),
        ("_core.cp311-win_amd64.pyd", Target("3.11", "Windows", "x86-64")),
        ("_core.cp311-win_arm64.pyd", Target("3.11", "Windows", "ARM")),
        ("_core.cp311-win32.pyd", Target("3.11", "Windows", "32-bit")),
        ("_core.abi3.so", None),
        ("_core.pyi", None),
    ],
)
def test_the_name_of_a_compiled_module_tells_what_it_is_for(name, target):
    assert target_of(name) == target


def test_this_python_is_known():
    target = installation.this_host().target
    assert target.python == f"{sys.version_info.major}.{sys.version_info.minor}"
    assert target.system
    assert target.machine


@pytest.mark.parametrize(
    ("modules", "here", "said"),
    [
        (
            [LINUX.format(311), LINUX.format(313)],
            host("3.12", blender="4.0.2"),
            "This release of Sparse Mocap does not work with Python 3.12 of this Blender 4.0.2, "
            "only with Python 3.11 (Blender 4.1 to 5.0 and Debian's 3.4) and "
            "3.13 (Blender 5.1 and later): install one of these Blenders",
        ),
        (
            [LINUX.format(311)],
            host("3.14", blender="5.2.2"),
            "This release of Sparse Mocap does not work with Python 3.14 of this Blender 5.2.2, "
            "only with Python 3.11 (Blender 4.1 to 5.0 and Debian's 3.4): "
            "install the release for Debian unstable's Blender 5.2",
        ),
        (
            [LINUX.format(311)],
            host("3.11", "Windows"),
            "This release of Sparse Mocap is for Linux (x86-64) and this Blender 4.2.1 is for "
            "Windows (x86-64): install the release for Windows (x86-64), if there is one",
        ),
        (
            [LINUX.format(311), LINUX.format(313)],
            host("3.11", "Linux", "ARM"),
            "This release of Sparse Mocap is for Linux (x86-64) and this Blender 4.2.1 is for "
            "Linux (ARM): install the release for Linux (ARM), if there is one",
        ),
        (
            ["_core.cp311-win_amd64.pyd"],
            host("3.11", "macOS", "ARM"),
            "This release of Sparse Mocap is for Windows (x86-64) and this Blender 4.2.1 is for "
            "macOS (ARM): install the release for macOS (ARM), if there is one",
        ),
        (
            [LINUX.format(311)],
            host(machine="32-bit"),
            "Sparse Mocap needs a 64-bit Blender and this one is 32-bit: install a 64-bit one",
        ),
    ],
)
def test_another_python_or_machine(tmp_path, modules, here, said):
    reason = import_problem(NO_CORE, here, package(tmp_path, *modules)).reason
    assert reason == said
    assert is_one_sentence(reason)


def test_a_removed_compiled_module(tmp_path):
    folder = package(tmp_path)
    assert import_problem(NO_CORE, host(), folder).reason == (
        f"The compiled file _core is missing in {installation_paths.home_hidden(str(folder))}, "
        f"an antivirus may have removed it: allow it there and {REINSTALL}"
    )


def test_one_of_several_modules_was_removed(tmp_path):
    folder = package(tmp_path, LINUX.format(313))
    released = "".join(f"{LINUX.format(number)}\n" for number in (311, 313))
    (folder / installation.RELEASED).write_text(released)
    said = import_problem(NO_CORE, host("3.11"), folder).reason
    assert said.startswith("The compiled file _core is missing in ")
    other = import_problem(NO_CORE, host("3.12"), folder).reason
    assert "only with Python 3.11 (Blender 4.1 to 5.0 and Debian's 3.4) and 3.13 (" in other
    here = import_problem(NO_CORE, host("3.11", system="Windows"), folder).reason
    assert here.startswith("This release of Sparse Mocap is for Linux (x86-64) and")


@pytest.mark.parametrize(
    ("error", "what"),
    [
        (ModuleNotFoundError("x", name="sparse_mocap"), "sparse_mocap is missing"),
        (ModuleNotFoundError("x", name="sparse_mocap.take"), "sparse_mocap/take is missing"),
        (
            ImportError("cannot import name 'a' from 'sparse_mocap.b' (/c/d/b.py)"),
            "cannot import name 'a' from 'sparse_mocap.b' (b.py)",
        ),
        (SyntaxError("'(' was never closed", ("/c/d/take.py", 3, 1, "x(")), "(take.py, line 3)"),
        (not_loaded("/c/d d/_core.so: file too short"), "(_core.so: file too short)"),
    ],
)
def test_an_incomplete_installation(error, what):
    reason = import_problem(error, host(), None).reason
    assert reason.startswith("The installation is incomplete (")
    assert what in reason
    assert reason.endswith(REINSTALL)
    assert is_one_sentence(reason)


@pytest.mark.parametrize(
    ("said", "reason"),
    [
        (
            "/lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.38' not found "
            "(required by /c/d/sparse_mocap/_core.so)",
            "This system is too old for this release of Sparse Mocap (libc.so.6: version "
            "`GLIBC_2.38' not found (required by _core.so)): update the system",
        ),
        (
            "dlopen(/c/_core.so, 0x0002): Symbol not found: __ZNSt3__1\n  Referenced from: /c/x",
            "This system is too old",
        ),
        (
            "libgomp.so.1: cannot open shared object file: No such file or directory",
            "Sparse Mocap needs a library of the system (libgomp.so.1: cannot open shared object "
            "file: No such file or directory): install it",
        ),
        ("/c/d/_core.so: wrong ELF class: ELFCLASS32", "is for another processor"),
        ("dlopen(/c/_core.so): (mach-o file, but is an incompatible architecture", "processor"),
        ("something else", f"cannot be loaded (something else): {REINSTALL}"),
        ("/c/d/_core.so: undefined symbol: PyDict_New2", REINSTALL),
    ],
)
def test_what_the_loader_says(said, reason):
    found = import_problem(not_loaded(said), host(), Path("/c/d"))
    assert reason in found.reason
    assert is_one_sentence(found.reason)


def test_a_missing_library_on_windows():
    said = "DLL load failed while importing _core: The specified module could not be found."
    reason = import_problem(not_loaded(said), host(system="Windows"), Path("/c/d")).reason
    assert reason.endswith("install the Microsoft Visual C++ Redistributable")


@pytest.mark.parametrize(
    ("version", "is_enough"),
    [("1.23.5", False), ("1.24.0", True), ("1.26.4", True), ("2.4.6", True), ("1.9", False)],
)
def test_an_old_numpy(tmp_path, version, is_enough):
    numpy = ModuleType("numpy")
    numpy.__version__, numpy.__file__ = version, str(tmp_path / "numpy" / "__init__.py")
    found = installation.numpy_problem(numpy)
    assert (found is None) == is_enough
    if found:
        assert found.reason.startswith(f"NumPy {version} in ")
        assert "is too old: install NumPy 1.24 or later" in found.reason
        assert is_one_sentence(found.reason)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ModuleNotFoundError("x", name="numpy"), "This Blender's Python has no NumPy: install"),
        (ImportError("bad\nNumPy"), "This Blender's NumPy cannot be loaded (bad NumPy): install"),
    ],
)
def test_no_numpy(error, said):
    reason = installation.numpy_problem(error).reason
    assert reason.startswith(said)
    assert is_one_sentence(reason)


def conflict(loaded, own, *, is_from_before=False):
    addon = (Path("/addons/ours"), "0.2.0")
    return installation.conflict(loaded, own, addon, is_from_before=is_from_before)


def test_two_places(tmp_path):
    other, own = package(tmp_path / "pip"), package(tmp_path / "vendor")
    hidden = installation_paths.home_hidden
    assert conflict((other, "0.1.0"), own).reason == (
        f"Sparse Mocap is installed twice, 0.2.0 in {hidden(str(own))} and 0.1.0 in "
        f"{hidden(str(other))}: remove the one that you do not need, and restart Blender"
    )
    assert conflict((other, "0.2.0"), own) is not None
    assert conflict((own, "0.2.0"), own) is None
    if os.name == "posix":
        link = tmp_path / "link"
        link.symlink_to(own)
        assert conflict((link, "0.2.0"), own) is None


def test_a_python_package_of_another_version(tmp_path):
    other = package(tmp_path / "pip")
    reason = conflict((other, "0.1.0"), None).reason
    assert reason.startswith("Two versions of Sparse Mocap are installed, the add-on 0.2.0 in ")
    assert "package 0.1.0 in" in reason
    assert is_one_sentence(reason)
    assert conflict((other, "0.2.0"), None) is None
    assert conflict((other, "0.2.0.dev1"), None) is None
    assert conflict((other, ""), None) is None


def test_an_upgrade_in_a_running_session(tmp_path):
    own = package(tmp_path / "vendor")
    restart = "Sparse Mocap 0.2.0 was installed while 0.1.0 was loaded: restart Blender"
    assert conflict((own, "0.1.0"), own, is_from_before=True).reason == restart
    assert conflict((tmp_path / "removed", "0.1.0"), own, is_from_before=True).reason == restart
    mixed = conflict((own, "0.1.0"), own).reason
    assert mixed.startswith("Files of Sparse Mocap 0.2.0 and 0.1.0 are mixed: restart Blender")
    assert mixed.endswith(REINSTALL)


@pytest.fixture
def looked_up(monkeypatch):
    """The core is looked up anew, and what was loaded is as it was afterwards."""
    before = {name: module for name, module in sys.modules.items() if _is_ours(name)}
    for name in before:
        monkeypatch.delitem(sys.modules, name)
    core._found.cache_clear()
    yield monkeypatch
    core._found.cache_clear()
    for name in [name for name in sys.modules if _is_ours(name)]:
        del sys.modules[name]


def _is_ours(name: str) -> bool:
    return name.split(".")[0] == "sparse_mocap"


@pytest.mark.parametrize("is_vendored", [True, False])
def test_the_loaded_core_is_compared_with_the_add_on(looked_up, tmp_path, is_vendored):
    own = package(tmp_path / "vendor")
    (own / "_core.py").write_text("__version__ = '0.0.9'")
    looked_up.setattr(core, "MODULES", ("sparse_mocap._core",))
    if is_vendored:
        looked_up.setattr(core, "VENDOR", own.parent)
        assert core.missing_reason().startswith("Files of Sparse Mocap ")
    else:
        looked_up.syspath_prepend(str(own.parent))
        assert core.missing_reason().startswith("Two versions of Sparse Mocap are installed")
    core._found.cache_clear()
    assert ("was loaded: restart" in core.missing_reason()) == is_vendored


def test_the_folder_without_its_first_file(looked_up, tmp_path):
    own = package(tmp_path / "vendor")
    (own / "__init__.py").unlink()
    (own / "_core.py").touch()
    looked_up.setattr(sys, "path", [str(tmp_path)])
    looked_up.setattr(core, "MODULES", ("sparse_mocap._core",))
    looked_up.setattr(core, "VENDOR", own.parent)
    looked_up.setattr(core, "_numpy_problem", lambda: None)
    assert "sparse_mocap/__init__.py is missing" in core.missing_reason()


def test_the_add_on_has_the_name_of_the_package(looked_up):
    module = ModuleType("sparse_mocap")
    module.__file__ = str(core.ADDON / "__init__.py")
    looked_up.setitem(sys.modules, "sparse_mocap", module)
    assert core.missing_reason() == (
        f"The add-on's folder must not be named sparse_mocap: {REINSTALL}"
    )


def test_a_hidden_numpy(looked_up):
    looked_up.setitem(sys.modules, "numpy", None)
    assert "has no NumPy" in core.missing_reason()


def test_versions_are_read_from_files(tmp_path):
    assert installation_paths.addon_version(tmp_path) == ""
    (tmp_path / "__init__.py").write_text('bl_info = {\n    "version": (0, 1, 2),\n}')
    assert installation_paths.addon_version(tmp_path) == "0.1.2"
    (tmp_path / "blender_manifest.toml").write_text('schema_version = "1"\nversion = "0.3.0"\n')
    assert installation_paths.addon_version(tmp_path) == "0.3.0"
    made = package(tmp_path)
    assert installation_paths.package_version(made) == ""
    (tmp_path / "sparse_mocap-0.4.0.dist-info").mkdir()
    assert installation_paths.package_version(made) == "0.4.0"


def test_an_extensions_package_lies_beside_all_extensions(tmp_path):
    addon = tmp_path / "extensions" / "user_default" / "sparse_mocap"
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    wheels = tmp_path / "extensions" / ".local" / "lib" / python / "site-packages"
    made = package(wheels)
    folders = installation_paths.own_folders(addon, is_extension=True)
    assert folders[:2] == [addon / "vendor", wheels]
    assert installation_paths.own_package(folders) == made
    assert installation_paths.own_folders(addon, is_extension=False) == [addon / "vendor"]


def test_names_of_people_are_hidden(monkeypatch):
    monkeypatch.setenv("USERNAME", "Erika M")
    home = Path("/home/erika")
    text = "/home/erika/x, /media/erika/y, /home/erika2 and /mnt/Erika M: erika, /a/erikas"
    assert installation_paths.home_hidden(text, home) == (
        "~/x, /media/USER/y, /home/erika2 and /mnt/USER: erika, /a/erikas"
    )


def test_the_report(tmp_path, monkeypatch):
    for variable in ("HOME", "USERPROFILE"):  # which of them counts depends on the system
        monkeypatch.setenv(variable, str(tmp_path / "erika"))
    vendor = tmp_path / "erika" / "addons" / "ours" / "vendor"
    package(vendor, LINUX.format(399))
    elsewhere = package(tmp_path / "erika" / "pip")
    monkeypatch.syspath_prepend(str(elsewhere.parent))
    (vendor.parent / "__init__.py").write_text('"version": (0, 1, 2)')
    problem = import_problem(NO_CORE, host("3.12"), vendor / "sparse_mocap")
    lines = report(problem, vendor.parent, "ours", [vendor, tmp_path / "none"]).split("\n")
    assert lines[0] == f"Sparse Mocap 0.1.2 as ours in ~{os.sep}addons{os.sep}ours"
    place = re.escape(installation.this_host().target.place)
    assert re.match(rf"Python 3\.\d+\.\d+\S*, 64-bit, for {place}$", lines[2])
    assert f"Reason: {problem.reason}" in lines
    assert any(line.startswith("Python said: ModuleNotFoundError: No module") for line in lines)
    looked_in = lines.index("Looked in:")
    ours, pip = Path("~/addons/ours/vendor/sparse_mocap"), Path("~/pip/sparse_mocap")
    assert lines[looked_in + 1] == f"  {ours}: {LINUX.format(399)}"
    assert lines[looked_in + 2].endswith(f"{Path('none/sparse_mocap')}: not there")
    assert f"  {pip}: no compiled module" in lines
    assert "erika" not in "\n".join(lines)
