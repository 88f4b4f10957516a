# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that end a command with one line and an exit code."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import IO, Any

import click

__all__ = ["Fault", "Stopped", "as_faults"]


class Fault(click.ClickException):
    """Wrong input; shown as one line without a traceback."""

    exit_code = 1

    def show(self, file: IO[Any] | None = None) -> None:
        """Prints the line."""
        click.echo(f"sparse-mocap: {' '.join(self.message.split())}", file=file, err=True)


class Stopped(Fault):
    """The user cancelled."""

    exit_code = 130


@contextmanager
def as_faults() -> Iterator[None]:
    """Turns errors caused by input, options or the system into faults."""
    try:
        yield
    except (click.ClickException, click.exceptions.Exit, click.Abort):
        raise
    except OSError as error:
        if isinstance(error, BrokenPipeError):
            raise
        raise Fault(_os_message(error)) from error
    except ImportError as error:
        raise Fault(_missing(error)) from error
    except Exception as error:
        if not isinstance(error, _core_errors()):
            raise
        raise (Stopped if _is_cancelled(error) else Fault)(str(error)) from error


def _core_errors() -> tuple[type[Exception], ...]:
    from .. import Cancelled, ConfigError, FormatError, MappingError
    from ..capture.errors import CaptureError

    return (FormatError, ConfigError, MappingError, Cancelled, CaptureError)


def _is_cancelled(error: Exception) -> bool:
    from .. import Cancelled

    return isinstance(error, Cancelled)


def _os_message(error: OSError) -> str:
    if error.filename is None or error.strerror is None:
        return str(error)
    return f"{error.filename}: {error.strerror}"


def _missing(error: ImportError) -> str:
    package = (error.name or "").partition(".")[0]
    package = {"serial": "pyserial"}.get(package, package)
    if package in ("matplotlib", "pyserial", "rich"):
        return f"this command needs {package}; install it with: pip install 'sparse-mocap[cli]'"
    return str(error)
