# SPDX-License-Identifier: GPL-3.0-or-later
"""The status display of ``sparse-mocap live``."""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .live_session import LiveSession

__all__ = ["view"]

LOW_BATTERY_PERCENT = 20.0
_COLOURS = {"streaming": "green", "live": "green", "failed": "red", "silent": "red"}


def view(status: dict[str, Any], session: LiveSession) -> RenderableType:
    """Returns a capture's links and sensors, and the state of the reconstruction."""
    return Group(
        *(_link(link) for link in status["links"]),
        _sensors(status),
        *(Text(note, "yellow") for note in status["notes"]),
        _reconstruction(session),
    )


def _link(link: dict[str, Any]) -> Text:
    state = link["state"]
    text = Text(f"{link['opened_as'] or link['port']}  {link['driver']}  ")
    text.append(state, _COLOURS.get(state, "yellow"))
    counters = link["counters"]
    problems = [
        f"{name} {count}" for name, count in counters.items() if count and name in _PROBLEMS
    ]
    return text.append(f"  {link['message'] or link['device_message']}  {', '.join(problems)}")


_PROBLEMS = ("bad_checksums", "malformed", "resyncs", "overruns", "device_resets", "device_errors")


def _sensors(status: dict[str, Any]) -> Table:
    table = Table(
        "sensor", "device", "rate", "lost", "x m/s²", "y m/s²", "z m/s²", "state", box=None
    )
    for column in table.columns[2:7]:
        column.justify = "right"
    for sensor in status["sensors"]:
        if sensor["is_replaced"]:
            continue
        force = sensor["specific_force"]
        values = ["", "", ""] if force is None else [f"{value:.2f}" for value in force]
        total = sensor["samples"] + sensor["missing"]
        state = sensor["state"]
        table.add_row(
            sensor["site"] or "none", f"{sensor['identity']}{_battery(sensor)}",
            f"{sensor['rate_hz']:.0f} Hz",
            f"{100 * sensor['missing'] / max(total, 1):.1f} %", *values,
            Text(state, _COLOURS.get(state, "yellow")),
        )  # fmt: skip
    return table


def _battery(sensor: dict[str, Any]) -> str:
    percent = sensor["battery"]
    if percent is None:
        return ""
    return f" battery {percent:.0f} %" + (", charge it" if percent < LOW_BATTERY_PERCENT else "")


def _reconstruction(session: LiveSession) -> Text:
    if not session.num_poses:
        return Text("Waiting for data from all sensors")
    return Text(
        f"{session.num_poses} poses  match {session.match}  delay from movement to pose "
        f"{1e3 * np.median(session.latencies_s):.0f} ms, including "
        f"{1e3 * np.median(session.step_s):.1f} ms of computing"
        + (f"\n{session.advice}" if session.advice else "")
    )
