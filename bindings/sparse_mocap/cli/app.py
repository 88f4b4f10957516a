# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of commands."""

from __future__ import annotations

import importlib
import io
import sys
from collections.abc import Sequence
from typing import Any

import click

from .faults import Fault, as_faults

__all__ = ["app", "run"]

_COMMANDS = {
    "batch": ".batch:batch",
    "body": ".body:body",
    "calibrate": ".calibrate:calibrate_command",
    "calibrate-poses": ".calibrate_poses:calibrate_poses",
    "convert": ".convert:convert",
    "database": ".database:database",
    "drivers": ".drivers:drivers",
    "emulate": ".emulate:emulate",
    "evaluate": ".evaluate:evaluate",
    "import": ".import_recording:import_recording",
    "inspect": ".inspect:inspect",
    "latent": ".latent:latent",
    "live": ".live:live",
    "merge": ".merge:merge",
    "methods": ".methods:methods",
    "phases": ".phases:phases",
    "ports": ".ports:ports",
    "reconstruct": ".reconstruct:reconstruct",
    "record": ".record:record",
    "simulate": ".simulate:simulate",
    "train": ".train:train",
}
"""Each command's name and module, which is imported only when the command is used."""


class _Commands(click.Group):
    """Imports commands when they are used and turns their exceptions into exit codes."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        module, name = _COMMANDS[cmd_name].split(":")
        with as_faults():
            command = getattr(importlib.import_module(module, __package__), name)
        assert isinstance(command, click.Command)
        return command

    def invoke(self, ctx: click.Context) -> Any:
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")  # for file names that are no text
        with as_faults():
            return super().invoke(ctx)


def _print_version(ctx: click.Context, _: click.Parameter, is_wanted: bool) -> None:
    if is_wanted and not ctx.resilient_parsing:
        with as_faults():
            from .. import __version__
        click.echo(f"sparse-mocap {__version__}")
        ctx.exit()


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_print_version,
    help="Show the version and exit.",
)  # fmt: skip
def app() -> None:
    """Full-body motion from a few motion sensors and a database of motion capture.

    Exit codes: 0 success, 1 wrong input, 2 wrong usage.
    """


def run(arguments: Sequence[str] | None = None) -> int:
    """Runs a command line (sys.argv when None) and returns its exit code."""
    try:
        result = app.main(
            arguments,
            prog_name="sparse-mocap",
            standalone_mode=False,
            windows_expand_args=False,  # patterns such as --exclude '*_raw.bvh' are for the command
        )
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except click.Abort:
        Fault("cancelled").show()
        return 130
    except BrokenPipeError:
        sys.stderr.close()  # nothing reads the output any more: suppress messages at exit
        return 1
    return result if isinstance(result, int) else 0
