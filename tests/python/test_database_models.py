# SPDX-License-Identifier: GPL-3.0-or-later
"""Models in files of their own and in motion databases; the public safetensors reads the same."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xxhash
from click.testing import Result
from safetensors import safe_open
from safetensors.numpy import load_file, save_file
from sparse_mocap import (
    FormatError,
    Model,
    MotionDatabase,
    add_to_database,
    drop_from_database,
    read_model,
    remove_model,
    store_model,
    write_model,
)

Cli = Callable[..., Result]
TYPES = ("bool", "uint8", "int8", "uint16", "int16", "float16", "uint32", "int32", "float32",
         "uint64", "int64", "float64", "complex64")  # fmt: skip


def tensors() -> dict[str, np.ndarray[Any, Any]]:
    source = np.random.default_rng(5)
    made = {name: (100 * source.random((3, 2))).astype(name) for name in TYPES}
    return made | {"scalar": np.array(2.5), "none": np.empty((0, 4), np.float32)}


def model() -> Model:
    return Model("liu2011", tensors(), metadata={"subjects": "12", "é": "\n"}, version=3)


def same(one: Model, other: Model) -> bool:
    mine, theirs = one.tensors, other.tensors
    return (
        (one.method, one.version, one.metadata) == (other.method, other.version, other.metadata)
        and mine.keys() == theirs.keys()
        and all(mine[name].dtype == theirs[name].dtype for name in mine)
        and all(mine[name].tobytes() == theirs[name].tobytes() for name in mine)
        and all(mine[name].shape == theirs[name].shape for name in mine)
    )


@pytest.fixture
def stored(database_path: Path, tmp_path: Path) -> Path:
    """A database with a model in it."""
    path = tmp_path / "db.smdb"
    shutil.copy(database_path, path)
    store_model(path, model())
    return path


def metadata_of(path: Path) -> dict[str, str]:
    with safe_open(path, "numpy") as file:
        return dict(file.metadata())


def sealed(metadata: dict[str, str], arrays: dict[str, Any]) -> dict[str, str]:
    """The metadata with checksums, as the format asks for them."""
    sums = {name: xxhash.xxh3_64_hexdigest(array.tobytes()) for name, array in arrays.items()}
    whole = metadata | {"checksums": json.dumps(sums)}
    whole.pop("metadata_checksum", None)
    text = "".join(f"{key}\0{whole[key]}\0" for key in sorted(whole))
    return whole | {"metadata_checksum": xxhash.xxh3_64_hexdigest(text.encode())}


def test_anyone_can_read_a_model_file(tmp_path: Path) -> None:
    path = tmp_path / "walk.smmodel"
    write_model(path, model())
    public = load_file(path)
    assert public.keys() == tensors().keys()
    for name, array in tensors().items():
        assert public[name].dtype == array.dtype
        np.testing.assert_array_equal(public[name], array)
    metadata = metadata_of(path)
    assert metadata["format"] == "sparse_mocap_model"
    assert (metadata["method"], metadata["model_version"]) == ("liu2011", "3")
    assert json.loads(metadata["metadata"]) == {"subjects": "12", "é": "\n"}
    sums = json.loads(metadata["checksums"])
    assert sums == {name: xxhash.xxh3_64_hexdigest(a.tobytes()) for name, a in tensors().items()}


def test_a_model_file_that_others_wrote_is_read(tmp_path: Path) -> None:
    path = tmp_path / "walk.smmodel"
    metadata = {
        "format": "sparse_mocap_model", "format_version": "1", "method": "liu2011",
        "model_version": "3", "metadata": json.dumps(model().metadata),
    }  # fmt: skip
    save_file(tensors(), path, sealed(metadata, tensors()))
    read = read_model(path)
    assert same(read, model())
    assert read.path == str(path)
    save_file(tensors(), path, metadata)
    with pytest.raises(FormatError, match="'metadata_checksum' is missing"):
        read_model(path)


def test_tensors_are_views_that_nobody_writes_to() -> None:
    weights = model().tensor("float64")
    assert weights.dtype == np.float64
    assert not weights.flags.writeable
    np.testing.assert_array_equal(weights, tensors()["float64"])  # its model is gone
    with pytest.raises(KeyError, match="nothing"):
        model().tensor("nothing")


def test_tensors_are_copied_whatever_their_memory() -> None:
    base = np.arange(12.0).reshape(3, 4)
    made = Model("m", {"turned": base.T, "part": base[::2, ::-1]})
    np.testing.assert_array_equal(made.tensor("turned"), base.T)
    np.testing.assert_array_equal(made.tensor("part"), base[::2, ::-1])


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("Liu 2011", {}), "method's name"),
        (("m", {"": np.ones(2)}), "tensor's name"),
        (("m", {"x": np.array([np.nan])}), "not a number"),
        (("m", {"x": np.array(["text"])}), "convert it with astype"),
        (("m", {"x": np.ones(2, ">f8")}), "convert it with astype"),
        (("m", {"x": np.ones(2, complex)}), "convert it with astype"),
    ],
)
def test_what_is_no_model_is_refused(arguments: tuple[Any, Any], part: str) -> None:
    with pytest.raises(ValueError, match=part):
        Model(*arguments)
    with pytest.raises(ValueError, match="version"):
        Model("m", version=0)


def test_a_damaged_model_is_refused_in_one_line(tmp_path: Path, database_path: Path) -> None:
    path = tmp_path / "walk.smmodel"
    write_model(path, model())
    whole = path.read_bytes()
    for damaged in (b"", whole[:100], whole[:-1], whole + b"\0", whole[:-5] + b"\1" + whole[-4:]):
        path.write_bytes(damaged)
        with pytest.raises(FormatError) as caught:
            read_model(path)
        assert str(caught.value).startswith(f"{path}: not a sound model: ")
        assert len(str(caught.value).splitlines()) == 1
    with pytest.raises(FormatError, match="is a motion database, not a model"):
        read_model(database_path)
    path.write_bytes(whole)
    with pytest.raises(FormatError, match="is a model, not a motion database"):
        MotionDatabase(path)
    with pytest.raises(FormatError, match="no such file"):
        read_model(tmp_path / "none.smmodel")


def test_a_database_keeps_a_model(stored: Path, database_path: Path) -> None:
    opened = MotionDatabase(stored)
    assert opened.model_names == ["liu2011"]
    assert same(opened.model("liu2011"), model())
    with pytest.raises(
        FormatError, match="holds no model of 'eom2014'; it holds models of liu2011"
    ):
        opened.model("eom2014")
    public, before = load_file(stored), load_file(database_path)
    for name, array in tensors().items():
        np.testing.assert_array_equal(public[f"models/liu2011/{name}"], array)
    for name, rows in before.items():
        np.testing.assert_array_equal(public[name], rows)
    remove_model(stored, "liu2011")
    assert stored.read_bytes() == database_path.read_bytes()
    with pytest.raises(FormatError, match="holds no model"):
        remove_model(stored, "liu2011")


def test_what_others_put_into_a_database_stays(
    stored: Path, performance: Path, tmp_path: Path
) -> None:
    arrays = load_file(stored)
    added = {f"of others/{name}": array for name, array in tensors().items()}
    metadata = metadata_of(stored) | {"of others": "a text"}
    save_file(arrays | added, stored, sealed(metadata, arrays))  # what is added has no checksum
    changes: list[Callable[[], object]] = [
        lambda: add_to_database(stored, [performance]),
        lambda: drop_from_database(stored, ["performance.bvh"]),
        lambda: store_model(stored, Model("eom2014")),
    ]
    for change in changes:
        change()
        after = load_file(stored)
        for name, array in added.items():
            assert after[name].dtype == array.dtype
            assert after[name].shape == array.shape
            assert after[name].tobytes() == array.tobytes()
        assert metadata_of(stored)["of others"] == "a text"
        assert json.loads(metadata_of(stored)["checksums"]).keys() == after.keys()
        assert same(MotionDatabase(stored).model("liu2011"), model())
    names = [name for name, *_ in MotionDatabase(stored).other_tensors]
    assert sorted(names) == sorted(added)


def test_info_lists_models_and_what_others_put_there(cli: Cli, stored: Path) -> None:
    arrays = load_file(stored) | {"spare": np.ones((2, 5), np.uint8)}
    save_file(arrays, stored, sealed(metadata_of(stored), arrays))
    told = json.loads(cli("database", "info", stored, "--json").stdout)
    (listed,) = told["models"]
    assert (listed["method"], listed["version"]) == ("liu2011", 3)
    assert listed["bytes"] == sum(array.nbytes for array in tensors().values())
    expected = {name: list(array.shape) for name, array in tensors().items()}
    assert {tensor["name"]: tensor["shape"] for tensor in listed["tensors"]} == expected
    assert told["other_arrays"] == [{"name": "spare", "type": "U8", "shape": [2, 5], "bytes": 10}]
    shown = cli("database", "info", stored).output
    assert "model    liu2011, version 3" in shown
    assert "float64 F64 [3, 2]" in shown
    assert "spare U8 [2, 5]" in shown


def test_info_shows_a_model_that_cannot_be_used(cli: Cli, stored: Path) -> None:
    arrays = load_file(stored)
    arrays["models/liu2011/float32"][0, 0] = np.nan
    save_file(arrays, stored, sealed(metadata_of(stored), arrays))
    result = cli("database", "info", stored)
    assert result.exit_code == 0
    assert "the model of 'liu2011' is not sound" in result.output
    told = json.loads(cli("database", "info", stored, "--json").stdout)
    assert "not a number" in told["models"][0]["problem"]
