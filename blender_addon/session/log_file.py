# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on did and what went wrong, in a file for bug reports. Needs no bpy, no NumPy."""

from __future__ import annotations

import logging
from contextlib import suppress
from logging.handlers import RotatingFileHandler
from pathlib import Path

from .errors import log
from .installation_paths import home_hidden

NAME = "sparse_mocap.log"
_LARGEST_BYTES = 1_000_000
_handlers: list[RotatingFileHandler] = []


class _HomeHidden(logging.Formatter):
    """Lines without the names of people."""

    def format(self, record: logging.LogRecord) -> str:
        """The line, or lines with what Python raised."""
        return home_hidden(super().format(record))


class _Repeated(logging.Filter):
    """Leaves out what was said just before: panels are drawn again and again."""

    _last = ""

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether the message differs from the last one."""
        message = record.getMessage()
        is_new, self._last = message != self._last, message
        return is_new


def begin(folder: Path) -> None:
    """Write to the log in this folder from now on, if files can be written there."""
    end()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        handler = RotatingFileHandler(
            folder / NAME, maxBytes=_LARGEST_BYTES, backupCount=1, encoding="utf-8"
        )
        handler.setFormatter(_HomeHidden("%(asctime)s %(levelname)s %(message)s"))
        handler.addFilter(_Repeated())
        log.addHandler(handler)
        log.setLevel(logging.INFO)
        _handlers.append(handler)


def end() -> None:
    """Close the log."""
    while _handlers:
        handler = _handlers.pop()
        log.removeHandler(handler)
        handler.close()


def path() -> Path | None:
    """The log that is being written; None without one."""
    return Path(_handlers[0].baseFilename) if _handlers else None


def last_lines(count: int) -> list[str]:
    """The newest lines of the log."""
    file = path()
    if file is None:
        return []
    try:
        return file.read_text("utf-8", errors="replace").splitlines()[-count:]
    except OSError:
        return []
