# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap merge``: joins takes of one performance that were recorded apart."""

from __future__ import annotations

from pathlib import Path

import click

from .. import read_take, site_names, write_take
from ..alignment import merged
from .console import warn
from .options import FilePath, SensorSite, Span, check_ending

__all__ = ["merge"]


@click.command()
@click.argument("takes", metavar="TAKE.csv...", type=FilePath, nargs=-1, required=True)
@click.option("-o", "--output", type=FilePath, required=True, help="The take file to write (.csv).")
@click.option(
    "--clap", "claps", type=Span(), multiple=True,
    help="When a take has the clap or jump that all takes have, as FROM:TO in its own seconds: "
    "once for all takes, or once for each. Without it, the strongest common event counts.",
)  # fmt: skip
@click.option(
    "--largest-lag", type=click.FloatRange(0.01, 3600), default=60.0, show_default=True,
    help="How many seconds apart the takes may begin.",
)  # fmt: skip
@click.option(
    "--site", "site_of", type=SensorSite(), multiple=True,
    help="Location of a sensor, by its name in the takes. Can be repeated.",
)  # fmt: skip
def merge(
    takes: tuple[Path, ...],
    output: Path,
    claps: tuple[tuple[float, float], ...],
    largest_lag: float,
    site_of: tuple[tuple[str, str], ...],
) -> None:
    """Joins takes that were recorded apart, such as by two phones, to one.

    Clap, or jump, once while all of them record: the clap puts their times on one clock, that of
    the first take.
    """
    check_ending(output, ".csv")
    if len(takes) < 2:
        raise click.UsageError("give two takes or more")
    if len(claps) not in (0, 1, len(takes)):
        raise click.UsageError("give one --clap for all takes, or one for each")
    spans = claps * len(takes) if len(claps) == 1 else claps
    named = [(path.stem, read_take(path)) for path in takes]
    whole, lags_s = merged(named, spans or None, largest_lag, dict(site_of))
    write_take(output, whole)
    for (name, _), lag_s in zip(named[1:], lags_s, strict=True):
        click.echo(f"{name}: begins {-lag_s:+.3f} s after {named[0][0]}")
    unnamed = [name for name in whole.sensors if name not in site_names()]
    if unnamed:
        warn([f"no location given for {', '.join(unnamed)}; add --site '{unnamed[0]}=SITE'"])
    click.echo(f"{output}: {len(whole.sensors)} sensors, {whole.end_s - whole.begin_s:.1f} s")
