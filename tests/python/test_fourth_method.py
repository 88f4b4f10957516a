# SPDX-License-Identifier: GPL-3.0-or-later
"""A further method, one folder and one name in a list, is everywhere by itself."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import sparse_mocap
from safetensors import safe_open
from sparse_mocap import read_motion

ROOT = Path(__file__).parents[2]
BUILT = ROOT / "build" / "release" / "tests" / "fourth_method"
SOURCE = ROOT / "tests" / "fourth_method" / "held_pose" / "method.cpp"

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Runs Python with a package whose compiled module has one method more."""
    if not BUILT.parent.exists():
        pytest.skip("only a development build compiles a further method")
    (module,) = BUILT.glob("_core*.so")
    folder = tmp_path_factory.mktemp("fourth")
    package = folder / "sparse_mocap"
    package.mkdir()
    for path in Path(sparse_mocap.__file__).parent.iterdir():
        if not path.name.startswith(("_core.", "__pycache__")):
            (package / path.name).symlink_to(path)
    (package / module.name).symlink_to(module)

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *map(str, words)],
            env=os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"},
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
        )

    return run


def test_a_method_is_small() -> None:
    assert len(SOURCE.read_text(encoding="utf-8").splitlines()) <= 60


def test_it_is_listed_with_its_option(run: Run) -> None:
    found = json.loads(run("-m", "sparse_mocap", "methods", "--json").stdout)
    (method,) = [one for one in found if one["name"] == "held_pose"]
    names = [one["name"] for one in found]
    assert names[:-1] == ["path_regression", "tautges2011", "liu2011", "eom2014"]
    assert method["needs"] == ["model"]
    assert [option["name"] for option in method["options"]] == ["height_m"]
    assert "height_m" in run("-m", "sparse_mocap", "methods", "held_pose").stdout


def test_it_is_trained_and_reconstructs_with_its_model_and_option(
    run: Run, library: Path, take_path: Path, tmp_path: Path
) -> None:
    model, output = tmp_path / "m.smmodel", tmp_path / "o.bvh"
    clip = library / "ada_walk_01.bvh"
    run("-m", "sparse_mocap", "train", clip, "--method", "held_pose", "-o", model)
    with safe_open(model, framework="numpy") as content:
        assert content.get_tensor("rotations").shape == (21, 4)
        assert content.metadata()["method"] == "held_pose"
    run("-m", "sparse_mocap", "reconstruct", take_path, "-o", output, "--method", "held_pose",
        "--model", model, "--offline", "--set", "height_m=1.25")  # fmt: skip
    motion, _ = read_motion(output)
    assert motion.frame_time_s == pytest.approx(1 / 30)
    assert motion.root_positions[:, 1] == pytest.approx(1.25, abs=1e-4)


def test_it_is_evaluated_with_models_that_do_not_know_the_test(run: Run, library: Path) -> None:
    done = run("-m", "sparse_mocap", "evaluate", "--database-source", library, "--scenario", 3,
               "--tests", "ada_walk_01.bvh", "--method", "held_pose")  # fmt: skip
    assert "held_pose, best" in done.stdout


def test_it_is_in_the_add_ons_menu(run: Run) -> None:
    menus = (
        "from blender_addon.session.methods import *;"
        "print(method_items()[-1], option_items('held_pose'), has_best_quality('held_pose'))"
    )
    done = run("-c", menus)
    assert "('held_pose', 'Held pose', 'Holds the pose that a clip begins with.')" in done.stdout
    assert "0 to 3" in done.stdout
    assert done.stdout.strip().endswith("True")
