# SPDX-License-Identifier: GPL-3.0-or-later
"""The log of the add-on."""

from pathlib import Path

import pytest

from blender_addon.session import log_file
from blender_addon.session.errors import InputError, log, one_line


@pytest.fixture
def folder(tmp_path):
    log_file.begin(tmp_path / "new")
    yield tmp_path / "new"
    log_file.end()


def test_errors_are_logged_with_what_python_raised_if_unexpected(folder):
    one_line(InputError("Choose a take first"))
    try:
        raise KeyError("bone")
    except KeyError as error:
        one_line(error)
    text = (folder / log_file.NAME).read_text("utf-8")
    assert "WARNING Choose a take first" in text
    assert "ERROR Unexpected KeyError" in text
    assert "Traceback" in text
    assert text.count("Traceback") == 1


def test_the_home_folder_is_hidden_and_what_is_repeated_left_out(folder):
    for _ in range(3):
        log.info("%s is missing", Path.home() / "take.csv")
    log.info("another")
    lines = log_file.last_lines(10)
    assert [line.split("INFO ")[1] for line in lines] == [
        str(Path("~") / "take.csv") + " is missing",
        "another",
    ]


def test_the_log_stays_small(folder, monkeypatch):
    log_file._handlers[0].maxBytes = 2000
    for number in range(200):
        log.info("line %d of many", number)
    sizes = {path.name: path.stat().st_size for path in folder.iterdir()}
    assert set(sizes) == {log_file.NAME, f"{log_file.NAME}.1"}
    assert max(sizes.values()) <= 2000
    assert log_file.last_lines(1)[0].endswith("line 199 of many")


def test_a_folder_that_cannot_be_written_leaves_no_log(tmp_path):
    (tmp_path / "file").write_text("")
    log_file.begin(tmp_path / "file")
    assert log_file.path() is None
    assert log_file.last_lines(5) == []
    log_file.end()
