# SPDX-License-Identifier: GPL-3.0-or-later
import os
import threading
import time

import pytest

from blender_addon.session.errors import InputError
from blender_addon.session.file_cache import FileCache


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


def _settled(cache, path):
    deadline = time.perf_counter() + 10
    while (entry := cache.peek(str(path))).is_opening:
        assert time.perf_counter() < deadline
        time.sleep(0.001)
    return entry


def test_get_opens_once_until_the_file_changes(file):
    loader = Loader()
    cache = FileCache("thing", loader)
    assert cache.get(str(file)) == cache.get(str(file)) == "one"
    assert len(loader.paths) == 1
    file.write_text("other")
    assert cache.get(str(file)) == "other"
    cache.forget()
    assert cache.get(str(file)) == "other"
    assert len(loader.paths) == 3


def test_peek_answers_at_once_and_knows_later(file):
    loader = Loader()
    loader.may_go_on.clear()
    cache = FileCache("thing", loader)
    assert cache.peek(str(file)).is_opening
    assert cache.peek(str(file)).is_opening
    loader.may_go_on.set()
    assert _settled(cache, file).value == "one"
    assert cache.get(str(file)) == "one"
    assert len(loader.paths) == 1


def test_peek_tells_what_is_wrong_in_one_line(file):
    cache = FileCache("thing", Loader())
    file.write_text("")
    assert _settled(cache, file).error == f"{file}: is empty"
    os.remove(file)
    with pytest.raises(FileNotFoundError) as missing:
        file.stat()
    assert str(missing.value.strerror) in _settled(cache, file).error


def test_a_file_peeked_at_meanwhile_is_not_overwritten_by_a_late_one(file, tmp_path):
    loader = Loader()
    loader.may_go_on.clear()
    cache = FileCache("thing", loader)
    cache.peek(str(file))
    second = tmp_path / "second.txt"
    second.write_text("two")
    cache.peek(str(second))
    loader.may_go_on.set()
    assert _settled(cache, second).value == "two"


@pytest.mark.parametrize("path", ["", "a\0b", os.curdir])
def test_what_is_no_file_is_said(path):
    with pytest.raises(InputError, match="thing"):
        FileCache("thing", Loader()).get(path)
