# SPDX-License-Identifier: GPL-3.0-or-later
import re
import sys
from types import SimpleNamespace

import pytest
from sparse_mocap.capture import CaptureError
from sparse_mocap.capture.errors import RecordingError

from blender_addon.session import core, sensors
from blender_addon.session.errors import InputError, one_line


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (ValueError("a.bvh:3:\n  no numbers"), "a.bvh:3: no numbers"),
        (FileNotFoundError(2, "No such file or directory", "x.csv"), "x.csv: No such file or"),
        (MemoryError(), "Not enough memory"),
        (RecordingError("x: no samples\nwere recorded"), "x: no samples were recorded"),
        (TypeError("odd\nthing"), "Unexpected TypeError: odd thing"),
    ],
)
def test_one_line(error, line):
    assert one_line(error).startswith(line)
    assert "\n" not in one_line(error)


@pytest.fixture
def looked_for(monkeypatch):
    def look_for(*modules):
        monkeypatch.setattr(core, "MODULES", modules)
        core._found.cache_clear()

    yield look_for
    core._found.cache_clear()


@pytest.mark.parametrize(
    ("module", "said"),
    [
        ("sparse_mocap.not_there", "sparse_mocap/not_there is missing"),
        ("not_there_at_all", "not_there_at_all is missing"),
    ],
)
def test_a_missing_package_is_explained(looked_for, module, said):
    looked_for(module)
    assert said in core.missing_reason()
    assert "install" in core.missing_reason()
    with pytest.raises(InputError, match=re.escape(said)):
        core.core()


def test_the_vendor_folder_is_looked_into_and_not_left_on_the_path(
    looked_for, monkeypatch, tmp_path
):
    (tmp_path / "sparse_mocap_in_a_box.py").write_text("x = 1")
    monkeypatch.setattr(core, "VENDOR", tmp_path)
    looked_for("sparse_mocap_in_a_box")
    before = list(sys.path)
    core.missing_reason()
    assert sys.modules.pop("sparse_mocap_in_a_box").x == 1
    assert sys.path == before


def test_an_empty_recording_names_its_folder_once(tmp_path):
    def nothing(folder, _):
        raise CaptureError(f"{folder}: no samples were recorded; check ports and drivers")

    module = SimpleNamespace(recording_to_take=nothing, CaptureError=CaptureError)
    logs = tmp_path / "capture"
    with pytest.raises(InputError) as raised:
        sensors._save(module, logs, 0, tmp_path / "takes")
    ports = "no samples were recorded; check ports and drivers"
    assert str(raised.value) == f"{ports}; what was received is in {logs}"
    assert not (tmp_path / "takes").exists()
