# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors as one line for the animator."""

import logging

log = logging.getLogger("sparse_mocap.blender")


class InputError(ValueError):
    """The request cannot be fulfilled; str() is one line: what is wrong and what to do."""


def one_line(error: BaseException) -> str:
    """The error as one line that an animator can act on."""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{error.filename}: {error.strerror}"
    text = " ".join(str(error).split())
    if isinstance(error, ValueError | OSError) and text:
        return text
    if isinstance(error, MemoryError):
        return "Not enough memory: close other programs, or use fewer or shorter files"
    log.debug("unexpected error", exc_info=error)
    return f"Unexpected {type(error).__name__}: {text}"
