# SPDX-License-Identifier: GPL-3.0-or-later
"""Disks that are full: one line, no half file, and nothing of a recording is lost.

A limit of the size of files stands for them: writing fails in the same place.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
from connected import connected
from live_support import until
from support import SITES, Skipped, addon, error_of, library, raised, settings

_LARGEST_FILE = 20_000  # bytes


@contextmanager
def full_disk() -> Iterator[None]:
    """Files that this process writes stay small; what it prints is not shown meanwhile."""
    if os.name == "nt":
        raise Skipped("Windows has no limit of the size of files")
    import resource

    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    shown, nowhere = (os.dup(1), os.dup(2)), os.open(os.devnull, os.O_WRONLY)
    for number in (1, 2):  # they may be large files too
        os.dup2(nowhere, number)
    resource.setrlimit(resource.RLIMIT_FSIZE, (_LARGEST_FILE, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        for number, kept in zip((1, 2), shown, strict=True):
            os.dup2(kept, number)
            os.close(kept)
        os.close(nowhere)
        signal.signal(signal.SIGXFSZ, handler)


def test_a_database_that_does_not_fit_leaves_no_file(tmp_path):
    path, source = tmp_path / "large.smdb", str(library().motions)
    build = bpy.ops.sparse_mocap.build_database
    with full_disk():
        said = error_of(lambda: build(source=source, filepath=str(path)))
    assert str(path) in said
    assert list(tmp_path.iterdir()) == []
    assert settings().database == ""


def test_a_recording_that_does_not_fit_is_kept_where_it_was_received(tmp_path):
    import sparse_mocap
    from sparse_mocap.capture import recording_to_take

    with connected(tmp_path) as session:
        bpy.ops.sparse_mocap.record_take()
        until(lambda: session.state.recording and session.state.recording["samples"] > 800)
        with full_disk():
            said = raised(RuntimeError, bpy.ops.sparse_mocap.stop_take)
        begin, _, folder = said.rpartition("; what was received is in ")
        assert "take-" in begin, said
        assert not list((tmp_path / "takes").glob("*.csv"))
        assert len(settings().takes) == 0
        take = recording_to_take(Path(folder), 0).take
        assert isinstance(take, sparse_mocap.Take)
        assert take.sites == SITES
        assert bpy.ops.sparse_mocap.record_take() == {"FINISHED"}  # there is room again
        until(lambda: session.state.recording and session.state.recording["samples"] > 400)
        assert bpy.ops.sparse_mocap.stop_take() == {"FINISHED"}
        assert len(settings().takes) == 1
        assert Path(folder).exists(), "what was not saved is gone"
    assert recording_to_take(Path(folder), 0).take.sites == SITES
    assert addon("session.live").current() is not None
