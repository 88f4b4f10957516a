# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors as one line for the animator."""

import logging

log = logging.getLogger("sparse_mocap.blender")


class InputError(ValueError):
    """The request cannot be fulfilled; str() is one line: what is wrong and what to do."""


def one_line(error: BaseException) -> str:
    """The error as one line that an animator can act on; it is logged too."""
    line, is_expected = _line(error)
    if is_expected:
        log.warning("%s", line)
    else:
        log.error("%s", line, exc_info=error)
    return line


def _line(error: BaseException) -> tuple[str, bool]:
    """The line, and whether such errors are to be expected."""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{error.filename}: {error.strerror}", True
    text = " ".join(str(error).split())
    is_captures = type(error).__module__.endswith("capture.errors")  # whose base is Exception
    if (is_captures or isinstance(error, ValueError | OSError)) and text:
        return text, True
    if isinstance(error, MemoryError):
        return "Not enough memory: close other programs, or use fewer or shorter files", True
    return f"Unexpected {type(error).__name__}: {text}", False
