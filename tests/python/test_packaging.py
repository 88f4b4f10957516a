# SPDX-License-Identifier: GPL-3.0-or-later
"""What `./dev package` makes of sources and compiled modules, on small ones made here."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import io
import json
import os
import shutil
import stat
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from made_modules import (
    MODULE_311,
    MODULE_313,
    WINDOWS_311,
    WINDOWS_313,
    small_modules,
    small_windows_modules,
)
from release_files import addons, archives, checks, project, release, sdist, wheels
from release_files.errors import PackagingError

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def modules(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return small_modules(tmp_path_factory.mktemp("modules"))


@pytest.fixture(scope="module")
def pyserial() -> tuple[str, bytes]:
    files = {"serial/__init__.py": b"port = 1\n", "pyserial-3.5.dist-info/METADATA": b"Name: x\n"}
    name = "pyserial-3.5.dist-info/RECORD"
    return "pyserial-3.5-py2.py3-none-any.whl", archives.zipped(
        {**files, name: wheels.record(files, name)}
    )


@pytest.fixture(scope="module")
def made(modules: dict[str, bytes], pyserial: tuple[str, bytes]) -> release.Release:
    return release.make_release(ROOT, modules, pyserial)


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """The files that name the version, to be changed."""
    for name in (
        "CMakeLists.txt",
        "bindings/pyproject.toml",
        "blender_addon/blender_manifest.toml",
        "blender_addon/__init__.py",
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def held(made: release.Release, ending: str) -> dict[str, bytes]:
    (found,) = (one.data for name, one in made.files.items() if name.endswith(ending))
    return archives.unzipped(found)


def extension(made: release.Release) -> dict[str, bytes]:
    return archives.unzipped(made.files[f"sparse_mocap-{made.version}.zip"].data)


# --- The version ---------------------------------------------------------------------------------


def test_all_files_name_the_same_version() -> None:
    version = project.read_version(ROOT)
    assert f"VERSION {version} " in (ROOT / "CMakeLists.txt").read_text()
    assert version in (ROOT / "CHANGELOG.md").read_text()


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("bindings/pyproject.toml", '\nversion = "', '\nversion = "9'),
        ("blender_addon/blender_manifest.toml", '\nversion = "', '\nversion = "9'),
        ("blender_addon/__init__.py", '"version": (', '"version": (9'),
    ],
)
def test_a_file_that_names_another_version_is_told(
    sources: Path, name: str, old: str, new: str
) -> None:
    text = (sources / name).read_text()
    assert old in text
    (sources / name).write_text(text.replace(old, new))
    with pytest.raises(PackagingError, match=f"^{name} says version 9.*: make them equal$"):
        project.read_version(sources)


# --- Archives ------------------------------------------------------------------------------------


def test_the_same_files_give_the_same_bytes_in_any_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    files = {"b/x.py": b"1" * 999, "a.py": b"2", "a-1.dist-info/RECORD": b"3"}
    backwards = dict(reversed(files.items()))
    for pack in (archives.zipped, archives.tarred):
        first = pack(files)
        monkeypatch.setattr("time.time", lambda: 2e9)
        assert pack(backwards) == first


def test_an_archive_is_readable_by_all_and_names_nobody() -> None:
    files = {"b.py": b"1", "a-1.dist-info/RECORD": b"3"}
    with zipfile.ZipFile(io.BytesIO(archives.zipped(files))) as archive:
        assert archive.namelist() == ["b.py", "a-1.dist-info/RECORD"]
        for entry in archive.infolist():
            assert stat.filemode(entry.external_attr >> 16) == "-rw-r--r--"
            assert entry.date_time == (1980, 1, 1, 0, 0, 0)
    with tarfile.open(fileobj=io.BytesIO(archives.tarred(files))) as archive:
        for member in archive:
            assert (member.uid, member.uname, member.gid, member.mode) == (0, "", 0, 0o644)
            assert member.mtime == 315532800


def test_a_release_made_twice_has_the_same_bytes(
    made: release.Release, modules: dict[str, bytes], pyserial: tuple[str, bytes]
) -> None:
    again = release.make_release(ROOT, dict(reversed(modules.items())), pyserial)
    assert {name: one.data for name, one in again.files.items()} == {
        name: one.data for name, one in made.files.items()
    }


def test_what_python_compiled_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "__pycache__").mkdir()
    for name in ("a.py", "b.so", "__pycache__/a.py"):
        (tmp_path / name).write_bytes(b"")
    assert archives.folder_files(tmp_path, (".py",)) == {"a.py": b""}


# --- Wheels --------------------------------------------------------------------------------------


def test_each_cpython_has_a_wheel_with_its_module_alone(
    made: release.Release, modules: dict[str, bytes]
) -> None:
    for name, tag in ((MODULE_311, "cp311"), (MODULE_313, "cp313")):
        ending = f"-{tag}-{tag}-manylinux_2_28_x86_64.whl"
        files = held(made, ending)
        info = f"sparse_mocap-{made.version}.dist-info"
        assert [path for path in files if path.endswith(".so")] == [f"sparse_mocap/{name}"]
        assert files[f"sparse_mocap/{name}"] == modules[name]
        assert f"Tag: {tag}-{tag}-manylinux_2_28_x86_64\n".encode() in files[f"{info}/WHEEL"]
        assert f"{info}/licenses/LICENSE" in files
        assert "sparse_mocap/capture/sketches/mpu6050.ino" in files
        assert f"{info}/licenses/licences/Eigen.txt" in files


def test_a_record_is_what_its_format_says(made: release.Release) -> None:
    files = held(made, "-cp311-cp311-manylinux_2_28_x86_64.whl")
    (text,) = (data.decode() for name, data in files.items() if name.endswith("/RECORD"))
    rows = {row[0]: row[1:] for row in csv.reader(io.StringIO(text))}
    assert rows.keys() == files.keys()
    for name, (hashed, size) in rows.items():
        if name.endswith("/RECORD"):
            assert (hashed, size) == ("", "")
            continue
        digest = hashlib.sha256(files[name]).hexdigest()
        padded = hashed.removeprefix("sha256=").translate(str.maketrans("-_", "+/")) + "="
        decoded = subprocess.run(["base64", "-d"], input=padded.encode(), capture_output=True)
        assert decoded.stdout.hex() == digest
        assert int(size) == len(files[name])


@pytest.mark.parametrize("change", ["content", "extra", "missing", "twice"])
def test_a_wrong_record_is_refused(change: str) -> None:
    files = {"a.py": b"1", "b.py": b"2"}
    name = "a-1.dist-info/RECORD"
    files[name] = wheels.record(files, name)
    assert checks.check_record("a.whl", archives.zipped(files)) == 3
    if change == "content":
        files["b.py"] = b"3"
    elif change == "extra":
        files["c.py"] = b"3"
    elif change == "missing":
        del files["b.py"]
    else:
        files[name] = files[name].splitlines(keepends=True)[0] + files[name]
    with pytest.raises(PackagingError, match=r"a\.whl: its RECORD "):
        checks.check_record("a.whl", archives.zipped(files))


def test_the_metadata_is_that_of_pyproject() -> None:
    lines = wheels.metadata(project.read_project(ROOT)).decode().splitlines()
    settings = tomllib.loads((ROOT / "bindings" / "pyproject.toml").read_text())["project"]
    assert f"Name: {settings['name']}" in lines
    assert f"Requires-Python: {settings['requires-python']}" in lines
    assert [line for line in lines if "extra ==" in line] == [
        f"Requires-Dist: {name}; extra == '{extra}'"
        for extra, names in settings["optional-dependencies"].items()
        for name in names
    ]


# --- The add-on ----------------------------------------------------------------------------------


def test_the_extension_has_its_wheels_and_a_manifest_that_names_them(
    made: release.Release, modules: dict[str, bytes], pyserial: tuple[str, bytes]
) -> None:
    files = extension(made)
    manifest = tomllib.loads(files["blender_manifest.toml"].decode())
    ours = f"sparse_mocap-{made.version}-py3-none-manylinux_2_28_x86_64.whl"
    assert manifest["platforms"] == ["linux-x64"]
    assert sorted(manifest["wheels"]) == sorted([f"./wheels/{ours}", f"./wheels/{pyserial[0]}"])
    assert manifest["version"] == made.version
    for reason in manifest["permissions"].values():
        assert 0 < len(reason) <= 64, "Blender's rule"
        assert reason[-1].isalnum(), "Blender's rule"
    assert {name for name in files if name.endswith(".whl")} == {
        name.removeprefix("./") for name in manifest["wheels"]
    }
    in_wheel = archives.unzipped(files[f"wheels/{ours}"])
    for name, data in modules.items():
        assert in_wheel[f"sparse_mocap/{name}"] == data
    assert in_wheel["sparse_mocap/compiled_modules.txt"].decode().split() == sorted(modules)
    assert files["LICENSE"].lstrip().startswith(b"GNU GENERAL PUBLIC LICENSE")
    assert {"__init__.py", "session/core.py"} <= files.keys()
    assert not any(name.startswith("vendor/") for name in files)


def test_every_part_of_others_comes_with_its_licence(made: release.Release) -> None:
    files = extension(made)
    listed = files["licences/README.txt"].decode()
    texts = {name for name in files if name.startswith("licences/")} - {"licences/README.txt"}
    assert len(texts) == 11
    for name in texts:
        assert name.removeprefix("licences/") in listed
        assert len(files[name]) > 500


def test_a_manifest_with_wheels_of_its_own_is_refused() -> None:
    with pytest.raises(PackagingError, match="already has"):
        addons.manifest('wheels = ["a.whl"]\n[permissions]\n', ["b.whl"], ["linux-x64"])


def test_the_plain_addon_holds_all_it_needs_for_cpython_3_11(
    made: release.Release, modules: dict[str, bytes]
) -> None:
    files = held(made, "-legacy-linux-x64.zip")
    assert {name.split("/")[0] for name in files} == {"sparse_mocap_addon"}
    vendor = "sparse_mocap_addon/vendor"
    assert files[f"{vendor}/sparse_mocap/{MODULE_311}"] == modules[MODULE_311]
    assert not any(MODULE_313 in name or name.endswith(".toml") for name in files)
    assert f"{vendor}/sparse_mocap/__init__.py" in files
    assert f"{vendor}/serial/__init__.py" in files
    assert f"{vendor}/pyserial-3.5.dist-info/METADATA" not in files
    assert b"bl_info" in files["sparse_mocap_addon/__init__.py"]
    assert "sparse_mocap_addon/LICENSE" in files


def test_the_plain_addon_does_not_hide_the_package(made: release.Release, tmp_path: Path) -> None:
    """The folder of add-ons is on Blender's module path, before the add-on adds its own."""
    with zipfile.ZipFile(
        io.BytesIO(archives.zipped(held(made, "-legacy-linux-x64.zip")))
    ) as zipped:
        zipped.extractall(tmp_path)
    program = (
        "import importlib\nfrom sparse_mocap_addon.session import core\n"
        "print(core._imported_all(('serial', 'sparse_mocap')).__file__)"
    )
    environment = {name: text for name, text in os.environ.items() if name != "PYTHONPATH"}
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**environment, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == str(
        tmp_path / "sparse_mocap_addon" / "vendor" / "sparse_mocap" / "__init__.py"
    )


# --- The source archive --------------------------------------------------------------------------


def test_the_source_archive_can_be_built_from_its_top(made: release.Release) -> None:
    top = f"sparse_mocap-{made.version}"
    with tarfile.open(fileobj=io.BytesIO(made.files[f"{top}.tar.gz"].data)) as archive:
        names = set(archive.getnames())
        member = archive.extractfile(f"{top}/pyproject.toml")
        assert member is not None
        settings = tomllib.loads(member.read().decode())["tool"]["scikit-build"]
    assert settings["cmake"]["source-dir"] == "."
    for package in settings["wheel"]["packages"]:
        assert f"{top}/{package}/__init__.py" in names
    for name in ("CMakeLists.txt", "core/CMakeLists.txt", "bindings/exports.map", "PKG-INFO"):
        assert f"{top}/{name}" in names
    of_core = {path.relative_to(ROOT) for path in (ROOT / "core").rglob("*.[ch]pp")}
    assert {f"{top}/{path.as_posix()}" for path in of_core} <= names
    assert not any(name.endswith(".so") or "sparse_mocap_demo" in name for name in names)


def test_a_pyproject_that_cannot_be_moved_is_told(tmp_path: Path) -> None:
    (tmp_path / "bindings").mkdir()
    (tmp_path / "CMakeLists.txt").write_text("")
    (tmp_path / "bindings" / "pyproject.toml").write_text("[project]\n")
    with pytest.raises(PackagingError, match=r"has no line cmake\.source-dir"):
        sdist.sdist_files(tmp_path, project.read_project(ROOT))


# --- The whole -----------------------------------------------------------------------------------


def test_what_is_written_is_listed_with_its_hash(made: release.Release, tmp_path: Path) -> None:
    (tmp_path / "sparse_mocap-0.0.9.zip").write_bytes(b"of an earlier run")
    headers = tmp_path / "headers" / "linux-x64-3.14"
    (headers / "cpython").mkdir(parents=True)
    (headers / "cpython" / "code.h").write_text("int code;\n")
    (headers / "patchlevel.h").write_text('#define PY_MAJOR 3\n#define PY_VERSION    "3.14.8"\n')
    words = "find -type f -printf '%P\\n' | LC_ALL=C sort | xargs sha256sum | sha256sum"
    header_hash = subprocess.check_output(words, shell=True, cwd=headers, text=True).split()[0]
    made = dataclasses.replace(made, headers=release.header_versions(headers.parent))
    shutil.rmtree(headers.parent)
    release.write_release(made, tmp_path)
    listed = (tmp_path / "SHA256SUMS").read_text().splitlines()
    on_disk = {path.name for path in tmp_path.iterdir()} - {"SHA256SUMS", "report.json"}
    assert {line.split("  ")[1] for line in listed} == on_disk == set(made.files)
    subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=tmp_path, check=True)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["version"] == made.version
    assert {module["name"] for module in report["modules"]} == {MODULE_311, MODULE_313}
    assert report["files"].keys() == set(made.files)
    assert report["headers"] == {"linux-x64-3.14": f"3.14.8, SHA-256 {header_hash}"}
    assert len(report["checks"]) == 5  # three wheels of ours, that of pyserial, the hashes
    assert len(list(release.table(made))) == 2 + 5 + 1 + 5


def test_a_release_for_two_systems_has_the_files_of_both(
    modules: dict[str, bytes], pyserial: tuple[str, bytes]
) -> None:
    both = {**modules, **small_windows_modules()}
    made = release.make_release(ROOT, both, pyserial)
    stem = f"sparse_mocap-{made.version}"
    of_windows = {f"{stem}-{tag}-{tag}-win_amd64.whl" for tag in ("cp311", "cp313")}
    assert of_windows | {f"{stem}-legacy-windows-x64.zip"} <= made.files.keys()
    files = extension(made)
    manifest = tomllib.loads(files["blender_manifest.toml"].decode())
    assert manifest["platforms"] == ["linux-x64", "windows-x64"]
    for platform, held_modules in (
        ("manylinux_2_28_x86_64", modules),
        ("win_amd64", small_windows_modules()),
    ):
        name = f"wheels/{stem}-py3-none-{platform}.whl"
        assert f"./{name}" in manifest["wheels"]
        assert set(checks.modules_in(archives.unzipped(files[name]))) == set(held_modules)
    legacy = held(made, "-legacy-windows-x64.zip")
    assert set(checks.modules_in(legacy)) == {WINDOWS_311}


@pytest.mark.parametrize("lone", [MODULE_313, WINDOWS_313])
def test_without_a_module_for_the_plain_addon_nothing_is_made(
    modules: dict[str, bytes], pyserial: tuple[str, bytes], lone: str
) -> None:
    both = {**modules, **small_windows_modules()}
    with pytest.raises(PackagingError, match="no module for cp311 on "):
        release.make_release(ROOT, {lone: both[lone]}, pyserial)
