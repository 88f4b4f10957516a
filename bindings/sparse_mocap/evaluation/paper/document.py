# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what the paper's evaluation found, as Markdown with pictures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ... import __version__
from ...files import write_text
from .common import EASED, PAPER
from .parts import PARTS
from .runs import Runs
from .section import Section, Table

__all__ = ["document", "write_document"]

PICTURES = "paper"
"""The folder of the pictures, beside the document."""

HEAD = """# The evaluation of Tautges et al. 2011

The tests of section 6 of *Motion Reconstruction Using Sparse Accelerometer Data* (ACM Trans. Graph.
30, 2011), with the method of the paper and with this project's own. `sparse-mocap evaluate --paper`
writes this file and its pictures.

The figures of the paper are pictures, and its text states hardly any error. What its text says is
beside each table, in our words.

- Error: RMS over the 21 joints, a mean over each clip's frames and then over clips. Root frame: the
  root's position and whole rotation removed, as the paper measures. Heading frame: position and
  heading removed, as the other figures of this project are given.
- {published}: K and I in the paper's proportion to the database, and
  poses as its energy gives them. {eased}: the same, shown with a
  short lag so that poses do not jump.
- A test's own clip is never in its database, nor its mirror image, its reversal, a copy, or a
  longer take that contains it: these are found by their poses, not by their names.
- Latency, of the filter of the readings and of the method, is in the tables of the three scenarios;
  a method has the same in all others.
"""


def document(sections: Mapping[str, Section], runs: Runs, date: str) -> str:
    """Returns the Markdown text; sections by the names of their parts."""
    head = HEAD.format(published=PAPER.label, eased=EASED.label)
    lines = [head.rstrip(), "", *_setting(runs, date)]
    missing = [name for name in PARTS if name not in sections]
    if missing:
        lines.append(f"**Not in this file: {', '.join(missing)}; `--part` names what is run.**")
    lines += ["", "## In short", ""]
    for section in sections.values():
        lines += [f"**{section.title}**", ""]
        lines += [f"- {finding}" for finding in section.findings] + [""]
    for section in sections.values():
        lines += _told(section)
    return "\n".join(lines).rstrip() + "\n"


def write_document(
    sections: Mapping[str, Section], runs: Runs, folder: Path, date: str
) -> list[Path]:
    """Writes PAPER.md and its pictures to a folder and returns their paths. Needs Matplotlib."""
    from .plots import draw

    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / "PAPER.md"]
    write_text(written[0], document(sections, runs, date))
    for section in sections.values():
        for name, plot in section.plots.items():
            written.append(draw(plot, folder / PICTURES / f"{name}.png"))
    return written


def _setting(runs: Runs, date: str) -> list[str]:
    database = runs.database()
    files = {clip.source for clip in database.clips}
    lines = [
        f"Data: `{runs.source.name}`, {len(files)} clips of {len(runs.actors)} performers,"
        f" {runs.recorded_seconds() / 60:.0f} min at {database.rate_hz:g} Hz, and mirrored copies"
        " (the paper: 370 min with mirrored copies)."
    ]
    if runs.more is not None:
        more = {clip.source for clip in runs.database("diverse").clips} - files
        folder = f"{runs.more.parent.name}/{runs.more.name}"
        lines[0] += f" Further recordings for figure 8: `{folder}`, {len(more)} clips."
    if runs.every > 1:
        lines.append(
            f"**One clip in {runs.every} alone is tested, where a part does not say more.**"
        )
    lines.append(
        f"Simulated accelerometers at wrists and ankles unless said. {__version__}, {date}."
    )
    return lines


def _clips(counts: Sequence[int]) -> str:
    if not counts:
        return ""
    several = f"{counts[0]} to {counts[-1]}" if len(counts) > 1 else f"{counts[0]}"
    return f"({several} clip{'' if counts == [1] else 's'} tested.)"


def _told(section: Section) -> list[str]:
    lines = [f"## {section.title}", "", f"*The paper:* {section.paper}", ""]
    lines += [f"*Here:* {section.method} {_clips(section.num_clips)}".rstrip(), ""]
    for table in section.tables:
        lines += [f"{table.caption}:", "", *_rows(table), ""]
    for name, plot in section.plots.items():
        lines += [f"![{plot.title}]({PICTURES}/{name}.png)", ""]
    return lines


def _rows(table: Table) -> Iterable[str]:
    yield _row(table.head)
    yield "|---" + "|---:" * (len(table.head) - 1) + "|"
    for row in table.rows:
        yield _row(row)


def _row(cells: Sequence[str]) -> str:
    return "|" + "".join(f" {cell} |".replace("  ", " ") for cell in cells)
