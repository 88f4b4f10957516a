# SPDX-License-Identifier: GPL-3.0-or-later
import os
import threading
import time

import pytest

from blender_addon.session.errors import InputError
from blender_addon.session.opened import Shelf


class Loader:
    """Reads a file's text and remembers how often it was asked to."""

    def __init__(self):
        self.paths = []
        self.may_go_on = threading.Event()
        self.may_go_on.set()

    def __call__(self, path):
        self.paths.append(path)
        assert self.may_go_on.wait(10)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        if not text:
            raise ValueError(f"{path}: is\nempty")
        return text


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "file.txt"
    path.write_text("one")
    return path


def _settled(shelf, path):
    deadline = time.monotonic() + 10
    while (entry := shelf.peek(str(path))).is_opening:
        assert time.monotonic() < deadline
        time.sleep(0.001)
    return entry


def test_get_opens_once_until_the_file_changes(file):
    loader = Loader()
    shelf = Shelf("thing", loader)
    assert shelf.get(str(file)) == shelf.get(str(file)) == "one"
    assert len(loader.paths) == 1
    file.write_text("other")
    assert shelf.get(str(file)) == "other"
    shelf.forget()
    assert shelf.get(str(file)) == "other"
    assert len(loader.paths) == 3


def test_peek_answers_at_once_and_knows_later(file):
    loader = Loader()
    loader.may_go_on.clear()
    shelf = Shelf("thing", loader)
    assert shelf.peek(str(file)).is_opening
    assert shelf.peek(str(file)).is_opening
    loader.may_go_on.set()
    assert _settled(shelf, file).value == "one"
    assert shelf.get(str(file)) == "one"
    assert len(loader.paths) == 1


def test_peek_tells_what_is_wrong_in_one_line(file):
    shelf = Shelf("thing", Loader())
    file.write_text("")
    assert _settled(shelf, file).error == f"{file}: is empty"
    os.remove(file)
    assert "No such file" in _settled(shelf, file).error


def test_a_file_peeked_at_meanwhile_is_not_overwritten_by_a_late_one(file, tmp_path):
    loader = Loader()
    loader.may_go_on.clear()
    shelf = Shelf("thing", loader)
    shelf.peek(str(file))
    second = tmp_path / "second.txt"
    second.write_text("two")
    shelf.peek(str(second))
    loader.may_go_on.set()
    assert _settled(shelf, second).value == "two"


@pytest.mark.parametrize("path", ["", "a\0b", os.curdir])
def test_what_is_no_file_is_said(path):
    with pytest.raises(InputError, match="thing"):
        Shelf("thing", Loader()).get(path)
