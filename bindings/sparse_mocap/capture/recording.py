# SPDX-License-Identifier: GPL-3.0-or-later
"""From a capture's raw log to a take, whenever one likes: later, meanwhile, or after a crash."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..take import SensorRecord, Take
from .clocks import LARGEST_DRIFT, host_times
from .config import CaptureConfig
from .decoder import Decoder
from .errors import RecordingError
from .raw_log import BEGUN, FILE_NAME, Kind, Record, read_log
from .sample_log import SAMPLE, Samples

__all__ = ["Gap", "RecordedTake", "recording_to_take"]

Floats = NDArray[np.float64]

GAP_S = 0.25
"""A silence of a sensor for longer than this is told of."""


@dataclass(frozen=True)
class Gap:
    """A time in which a sensor was not heard."""

    site: str
    begin_s: float
    end_s: float

    def __str__(self) -> str:
        return f"gap: {self.site} was not heard from {self.begin_s:.3f} s to {self.end_s:.3f} s"


@dataclass(frozen=True)
class RecordedTake:
    """A recording as a take; its times begin with its first sample."""

    take: Take
    gaps: tuple[Gap, ...]
    names: tuple[str, ...]
    """What the devices call themselves, in the take's order."""
    are_sites_guessed: bool
    """Nobody said where the sensors are worn: they are in the order of the devices."""
    clock_rates: tuple[float, ...]
    """Seconds of the machine to one of each sensor's device."""
    num_missing: int
    """Samples that the devices counted and that never came."""
    begin_ns: int
    """Of the take's time 0, on the machine's monotonic clock."""

    @property
    def warnings(self) -> list[str]:
        """What the user ought to know, a line each."""
        lines = [str(gap) for gap in self.gaps]
        if self.are_sites_guessed:
            pairs = zip(self.take.sites, self.names, strict=True)
            told = ", ".join(f"{name} as {site}" for site, name in pairs)
            lines.append(f"nobody said where the sensors are worn; took {told} (see --sites)")
        if self.num_missing:
            lines.append(f"{self.num_missing} samples were lost before they arrived")
        odd = [rate for rate in self.clock_rates if abs(rate - 1.0) > LARGEST_DRIFT]
        if odd:
            lines.append(f"a device's clock is {1 / odd[0]:.2f} times too fast; its times are kept")
        return lines


@dataclass
class _Replay:
    """What the log holds, decoded."""

    config: CaptureConfig
    decoder: Decoder
    parts: list[Samples] = field(default_factory=list)
    epochs: list[NDArray[np.int64]] = field(default_factory=list)
    """For each sample the how manieth connection of its link it came by."""
    begins_ns: list[int] = field(default_factory=list)
    ends_ns: dict[int, int] = field(default_factory=dict)
    is_repeated: bool = False
    """What comes tells how the connections began; its samples belong to no recording."""
    _connections: dict[int, int] = field(default_factory=dict)

    def take_up(self, record: Record) -> None:
        if record.kind is Kind.EVENT:
            self._take_up_event(record)
            return
        is_datagram = record.kind is Kind.DATAGRAM
        sender, data = record.datagram if is_datagram else ("", record.payload)
        samples = self.decoder.arrived(record.link, record.arrival_ns, data, sender).samples
        if self.is_repeated:
            return
        self.parts.append(samples)
        self.epochs.append(np.full(len(samples), self._connections.get(record.link, 0)))

    def _take_up_event(self, record: Record) -> None:
        event = record.event
        what = event.get("event")
        if what == "capture":
            self.is_repeated = bool(event.get("is_later"))
        elif what == BEGUN:
            self.is_repeated = False
            self.decoder.interrupted()
        elif what == "connected":
            self.decoder.connected(record.link, record.arrival_ns)
            self._connections[record.link] = self._connections.get(record.link, 0) + 1
        elif what == "recording":
            self.begins_ns.append(record.arrival_ns)
        elif what == "recording_end":
            self.ends_ns[int(event["number"])] = record.arrival_ns


def recording_to_take(
    folder: str | os.PathLike[str], number: int | None = None, sites: tuple[str, ...] = ()
) -> RecordedTake:
    """Returns a recording of the capture in a folder, the last when no number is given.

    A capture without a recording is taken whole. ``sites`` says where the sensors were worn, in
    their order, when the capture was not told. Raises RecordingError and OSError.
    """
    replay = _replayed(Path(folder), sites)
    decoder = replay.decoder
    samples = np.concatenate([np.empty(0, SAMPLE), *replay.parts])
    epochs = np.concatenate([np.empty(0, np.int64), *replay.epochs])
    bounds_ns = _bounds(replay, folder, number)
    heard: dict[str, _Heard] = {}
    for index in decoder.order:
        own = (samples["sensor"] == index) & np.isfinite(samples["specific_force"]).all(axis=1)
        of_sensor = _heard(samples[own], epochs[own], bounds_ns, decoder.sensors[index].name)
        if len(of_sensor.times_s):
            heard[decoder.sites[index]] = of_sensor
    if not heard:
        raise RecordingError(f"{folder}: no sample was recorded; check ports and drivers")
    begin_s = min(float(of_sensor.times_s[0]) for of_sensor in heard.values())
    gaps = [gap for site, h in heard.items() for gap in _gaps(site, h.times_s - begin_s)]
    about = (
        f"recorded with {', '.join(dict.fromkeys(link.driver for link in replay.config.links))}",
        "sensors: " + ", ".join(f"{site} is {h.name}" for site, h in heard.items()),
        *(str(gap) for gap in gaps),
    )
    return RecordedTake(
        Take({site: h.record(begin_s) for site, h in heard.items()}, about),
        tuple(gaps),
        tuple(h.name for h in heard.values()),
        decoder.are_sites_guessed,
        tuple(h.clock_rate for h in heard.values()),
        sum(sensor.num_missing for sensor in decoder.sensors),
        round(begin_s * 1e9),
    )


def _replayed(folder: Path, sites: tuple[str, ...]) -> _Replay:
    replay: _Replay | None = None
    try:
        for record in read_log(folder):
            if replay is None and record.is_event("capture"):
                config = CaptureConfig.from_json(record.event["config"])
                config = replace(config, sites=sites or config.sites)
                replay = _Replay(config, Decoder(config))
            if replay is not None:
                replay.take_up(record)
    except ValueError as error:
        raise RecordingError(str(error)) from error
    if replay is None:
        raise RecordingError(f"{folder / FILE_NAME}: the capture ended before it began")
    return replay


def _bounds(replay: _Replay, folder: str | os.PathLike[str], number: int | None) -> tuple[int, int]:
    """Begin and end of the recording; the end of the log for one that never ended."""
    for_ever = np.iinfo(np.int64).max
    if number is None:
        if not replay.begins_ns:
            return 0, for_ever
        number = len(replay.begins_ns) - 1
    if not 0 <= number < len(replay.begins_ns):
        raise RecordingError(f"{folder}: there is no recording {number}")
    return replay.begins_ns[number], replay.ends_ns.get(number, for_ever)


@dataclass(frozen=True)
class _Heard:
    """What one sensor said during the recording."""

    name: str
    times_s: Floats
    """On the machine's monotonic clock."""
    samples: Samples
    clock_rate: float

    def record(self, begin_s: float) -> SensorRecord:
        times_s = np.round(self.times_s - begin_s, 6)
        keep = np.diff(times_s, prepend=-np.inf) > 0

        def column(name: str) -> Floats | None:
            values = self.samples[name][keep].astype(np.float64)
            return values if np.isfinite(values).all() else None

        force = column("specific_force")
        assert force is not None
        return SensorRecord(times_s[keep], force, column("angular_velocity"), column("orientation"))


def _heard(
    samples: Samples, epochs: NDArray[np.int64], bounds_ns: tuple[int, int], name: str
) -> _Heard:
    """Clocks are learnt from all that a sensor said; kept is what arrived during the recording."""
    times_s, rate = np.empty(len(samples)), 1.0
    arrival_s = samples["arrival_ns"] * 1e-9
    for epoch in np.unique(epochs):  # each connection has a clock of its own
        own = epochs == epoch
        times_s[own], rate = host_times(samples["device_time_s"][own], arrival_s[own])
    times_s = np.maximum.accumulate(times_s)
    is_in = (samples["arrival_ns"] >= bounds_ns[0]) & (samples["arrival_ns"] <= bounds_ns[1])
    return _Heard(name, times_s[is_in], samples[is_in], rate)


def _gaps(site: str, times_s: Floats) -> list[Gap]:
    steps = np.diff(times_s)
    return [
        Gap(site, float(times_s[i]), float(times_s[i + 1])) for i in np.flatnonzero(steps > GAP_S)
    ]
