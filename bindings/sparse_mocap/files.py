# SPDX-License-Identifier: GPL-3.0-or-later
"""Atomic writing of files: complete or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

__all__ = ["remove_folder", "replaced", "write_text"]

_DENIED_FOR_S = 1.0
"""How long a replacement is tried again. Windows refuses to replace a file that somebody reads."""
_OPEN_FOR_S = 5.0
"""How long a folder is tried to be removed."""


@contextmanager
def replaced(path: str | os.PathLike[str], *, is_private: bool = False) -> Iterator[Path]:
    """Yields a temporary path to write to, which replaces ``path`` when the block succeeds.

    If the block raises, ``path`` is unchanged and nothing is left behind. A new file that
    is_private can be read by its user alone.
    """
    target = Path(path)
    if target.is_dir():
        raise IsADirectoryError(21, "Is a directory", str(target))
    try:
        handle, name = tempfile.mkstemp(
            dir=target.parent, prefix=f".{target.stem}.", suffix=target.suffix
        )
    except OSError as error:  # report the target, not the temporary file
        raise type(error)(error.errno, error.strerror, str(target)) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        _replace(temporary, target, 0o600 if is_private else 0o666 & ~_umask())
    except BaseException as error:
        with suppress(OSError):
            temporary.unlink()
        # A full disk, for one: report the target here as well.
        if (
            isinstance(error, OSError)
            and error.filename in (None, name)
            and error.errno is not None
        ):
            raise type(error)(error.errno, error.strerror, str(target)) from None
        raise


def write_text(path: str | os.PathLike[str], text: str, *, is_private: bool = False) -> None:
    """Writes UTF-8 text atomically, keeping the line ends in ``text``; is_private as above."""
    with replaced(path, is_private=is_private) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def remove_folder(path: str | os.PathLike[str]) -> None:
    """Removes a folder with its content, or leaves what cannot be removed.

    Windows removes no file that another process has open: one that ends gets some time for it.
    """
    end = time.perf_counter() + _OPEN_FOR_S
    while True:
        shutil.rmtree(path, ignore_errors=True)
        if not os.path.lexists(path) or time.perf_counter() >= end:
            return
        time.sleep(0.02)


def _replace(temporary: Path, target: Path, new_mode: int) -> None:
    mode = target.stat().st_mode if target.exists() else new_mode
    with temporary.open("r+b") as file:  # Windows syncs no file that is open for reading alone
        os.fsync(file.fileno())
    temporary.chmod(mode & 0o777)
    end = time.perf_counter() + _DENIED_FOR_S
    while True:
        try:
            os.replace(temporary, target)
            return
        except PermissionError:
            if time.perf_counter() >= end:
                raise
        time.sleep(0.01)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
