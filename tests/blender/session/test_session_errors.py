# SPDX-License-Identifier: GPL-3.0-or-later
import re
import sys

import pytest

from blender_addon.session import core
from blender_addon.session.errors import InputError, one_line


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (ValueError("a.bvh:3:\n  no numbers"), "a.bvh:3: no numbers"),
        (FileNotFoundError(2, "No such file or directory", "x.csv"), "x.csv: No such file or"),
        (MemoryError(), "Not enough memory"),
        (TypeError("odd\nthing"), "Unexpected TypeError: odd thing"),
    ],
)
def test_one_line(error, line):
    assert line in one_line(error)
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
