# SPDX-License-Identifier: GPL-3.0-or-later
"""In the live panel nothing moves under the pointer, whatever sensors and poses do."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import bpy
from support import addon, library, settings

_PAIRS = {"leave_live": "go_live", "stop_take": "record_or_stop"}
_SENSOR = {
    "identity": "S1",
    "site": "left_wrist",
    "state": "live",
    "rate_hz": 100.0,
    "missing": 0,
    "battery": None,
}
_LINK = {
    "port": "/dev/ttyUSB0",
    "opened_as": "",
    "driver": "xsens_mt",
    "state": "streaming",
    "message": "",
}


class _Layout:
    """Counts lines as Blender lays them out: what stands in a row or split is on one line."""

    def __init__(self, lines: list[str], *, is_line: bool = False) -> None:
        self._lines, self._is_line = lines, is_line

    def __getattr__(self, name: str) -> Any:
        if name in ("row", "split"):
            return self._row
        if name in ("box", "column"):
            return lambda **_: self if self._is_line else _Layout(self._lines)
        return lambda *arguments, **_: self._add(name, arguments)

    def __setattr__(self, name: str, value: object) -> None:
        if name.startswith("_"):
            super().__setattr__(name, value)

    def _row(self, **_: object) -> _Layout:
        if not self._is_line:
            self._lines.append("")
        return _Layout(self._lines, is_line=True)

    def _add(self, kind: str, arguments: tuple) -> SimpleNamespace:
        if not self._is_line:
            self._lines.append("")
        if kind == "operator":
            name = arguments[0].removeprefix("sparse_mocap.")
            self._lines[-1] += f" {_PAIRS.get(name, name)}"
        return SimpleNamespace()


def _lines(state: Any, *, is_live: bool) -> list[str]:
    session = SimpleNamespace(label="xsens_mt", state=state, is_live_wanted=is_live)
    lines: list[str] = []
    addon("ui.live")._session(_Layout(lines), bpy.context, session)
    return lines


def _buttons(state: Any) -> list[str]:
    """The names of the operators that record or stop, as the panel shows them."""
    before = dict(_PAIRS)
    _PAIRS.clear()
    try:
        return _lines(state, is_live=False)
    finally:
        _PAIRS.update(before)


def test_buttons_stay_where_they_are():
    settings().database = str(library().database)
    state_of = addon("session.live").LiveState
    quality = addon("session.live_poses").Quality(20, 3, "fair", 0.08, 0.1)
    calm = {"is_connected": True, "links": (_LINK,), "sensors": (_SENSOR, _SENSOR)}
    troubled = {**_SENSOR, "state": "silent", "missing": 12, "battery": 7.0}
    changes: list[dict[str, Any]] = [
        {},
        {"quality": quality, "is_live": True},
        {"no_readings": "No readings for 3 s: the cable is out"},
        {"warning": "The database has other sensors", "notes": ("Two sensors at one place",)},
        {"sensors": (troubled, _SENSOR)},
        {"links": ({**_LINK, "state": "failed", "message": "unplugged; waiting " * 9},)},
        {"recording": {"seconds": 12.0, "samples": 100}},
        {"shaking": "left_ankle"},
    ]
    wanted = _lines(state_of(**calm), is_live=False)
    assert sum("record_or_stop" in line for line in wanted) == 1
    assert sum("go_live" in line for line in wanted) == 1
    for change in changes:
        for is_live in (False, True):
            found = _lines(state_of(**{**calm, **change}), is_live=is_live)
            assert len(found) == len(wanted), change
            assert found == wanted, change


def test_a_calibration_is_not_asked_to_stop_its_own_recording():
    jobs, calibrating = addon("session.job"), addon("session.calibrating").CALIBRATING
    recording = {"is_connected": True, "sensors": (_SENSOR,), "recording": {"seconds": 1.0}}
    state = addon("session.live").LiveState(**recording)
    before = jobs.current
    try:
        assert any("stop_take" in line for line in _buttons(state))
        jobs.current = lambda: SimpleNamespace(
            label=calibrating, fraction=0.5, what="", is_cancelled=False
        )
        assert not any("stop_take" in line for line in _buttons(state))
    finally:
        jobs.current = before


def test_views_are_redrawn_only_when_what_they_show_has_changed():
    job_operator = addon("ops.job_operator")
    compat, redrawn = job_operator.compat, []
    operator, redraw = job_operator.JobOperator(), compat.redraw_views
    compat.redraw_views = redrawn.append
    job = SimpleNamespace(label="Working", fraction=0.5, what="", is_cancelled=False)
    job.is_running = True
    try:
        for fraction, what, wanted in ((0.5, "", 1), (0.504, "", 1), (0.51, "", 2), (0.51, "a", 3)):
            job.fraction, job.what = fraction, what
            operator._show_progress(bpy.context, job)
            assert len(redrawn) == wanted
    finally:
        compat.redraw_views = redraw
        compat.clear_status(bpy.context)
