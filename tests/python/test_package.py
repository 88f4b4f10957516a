# SPDX-License-Identifier: GPL-3.0-or-later
"""The package's face: what it offers, with and without its compiled core."""

from __future__ import annotations

import platform
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import sparse_mocap


def run_python(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )


def test_every_public_name_is_there() -> None:
    for name in sparse_mocap.__all__:
        assert getattr(sparse_mocap, name) is not None
    assert set(sparse_mocap.__all__) <= set(dir(sparse_mocap))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        sparse_mocap.nothing  # noqa: B018


def test_without_a_core_one_line_names_this_python() -> None:
    done = run_python(
        "import sys; sys.modules['sparse_mocap._core'] = None; import sparse_mocap\n"
        "try:\n    sparse_mocap.MotionDatabase\nexcept ImportError as error:\n    print(error)"
    )
    assert done.stderr == ""
    assert len(done.stdout.splitlines()) == 1
    assert f"CPython {platform.python_version()}" in done.stdout


@pytest.mark.parametrize("ending", ["cpython-39-x86_64-linux-gnu.so", "cp39-win_amd64.pyd"])
def test_without_a_core_the_line_names_those_that_are_there(tmp_path: Path, ending: str) -> None:
    package = tmp_path / "sparse_mocap"
    package.mkdir()
    shutil.copy(str(sparse_mocap.__file__), package)
    (package / f"_core.{ending}").write_bytes(b"")
    (package / "_core.pyi").write_bytes(b"")
    done = run_python(
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import sparse_mocap\n"
        "try:\n    sparse_mocap.MotionDatabase\nexcept ImportError as error:\n    print(error)"
    )
    assert done.stderr == ""
    assert f"(the folder holds _core.{ending})" in done.stdout


def test_the_command_without_a_core_says_so_in_one_line() -> None:
    done = run_python(
        "import sys; sys.modules['sparse_mocap._core'] = None\n"
        "from sparse_mocap.cli import main; sys.exit(main(['database', 'info', 'x']))"
    )
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert platform.python_version() in done.stderr


def test_demo_motions_do_not_need_the_core() -> None:
    done = run_python(
        "import sys; sys.modules['sparse_mocap._core'] = None\n"
        "from sparse_mocap.demo_motions import generate_library; print(generate_library.__name__)"
    )
    assert done.stdout.strip() == "generate_library", done.stderr


@pytest.mark.parametrize("missing", ["click", "rich"])
def test_the_command_without_its_extra_says_what_to_install(missing: str) -> None:
    done = run_python(
        f"import sys; sys.modules[{missing!r}] = None\n"
        "from sparse_mocap.cli import main; sys.exit(main(['database', 'info', 'x']))"
    )
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "sparse-mocap[cli]" in done.stderr
