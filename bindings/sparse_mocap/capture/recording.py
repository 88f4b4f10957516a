# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a capture's raw log to a take: during the capture, later, or after a crash."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import LARGEST_CLOCK_DRIFT, host_times, site_names
from ..take import SensorRecord, Take
from ..take_file import device_comment
from .config import CaptureConfig
from .decoder import Decoder
from .errors import RecordingError
from .raw_log import BEGUN, FILE_NAME, Kind, LogFormatError, Record, read_log
from .sample_log import SAMPLE, Samples

__all__ = ["Gap", "RecordedTake", "recording_to_take"]

Floats = NDArray[np.float64]

_MOST_LINKS = 256
GAP_S = 0.25
"""A pause of a sensor longer than this is reported."""


@dataclass(frozen=True)
class Gap:
    """A time without data from a sensor."""

    site: str
    begin_s: float
    end_s: float

    def __str__(self) -> str:
        return f"gap: no data from {self.site} between {self.begin_s:.3f} s and {self.end_s:.3f} s"


@dataclass(frozen=True)
class RecordedTake:
    """A recording as a take; its times start with its first sample."""

    take: Take
    gaps: tuple[Gap, ...]
    identities: tuple[str, ...]
    """The devices' identities, in the take's order."""
    conflicts: tuple[str, ...]
    """Sites that several sensors have; these were recorded under their identities."""
    unknown: tuple[str, ...]
    """Names that were given a site and that no sensor has."""
    clock_rates: tuple[float, ...]
    """Seconds of this machine per second of each sensor's device."""
    num_missing: int
    """Samples lost by the devices' counters."""
    begin_ns: int
    """The take's time 0 on this machine's monotonic clock."""

    @property
    def warnings(self) -> list[str]:
        """Warnings for the user, one line each."""
        lines = [str(gap) for gap in self.gaps]
        lines += self.conflicts
        known = site_names()
        unnamed = [] if self.conflicts else [n for n in self.take.sites if n not in known]
        if unnamed:
            lines.append(
                f"no sensor location is known for {', '.join(unnamed)}; recorded under that name, "
                f"give it with --site '{unnamed[0]}=left_wrist'"
            )
        for name in self.unknown:
            lines.append(f"there is no sensor {name!r}; there are {', '.join(self.identities)}")
        if self.num_missing:
            lines.append(f"{self.num_missing} samples were lost on the way from the sensors")
        odd = [rate for rate in self.clock_rates if abs(rate - 1.0) > LARGEST_CLOCK_DRIFT]
        if odd:
            lines.append(
                f"a device's clock is {1 / odd[0]:.2f} times too fast; its own times are used"
            )
        return lines


@dataclass
class _Replay:
    """The decoded log."""

    config: CaptureConfig
    decoder: Decoder
    parts: list[Samples] = field(default_factory=list)
    epochs: list[NDArray[np.int64]] = field(default_factory=list)
    """For each sample, its link and the number of that link's connection."""
    begins_ns: list[int] = field(default_factory=list)
    ends_ns: dict[int, int] = field(default_factory=dict)
    is_repeated: bool = False
    """In the repeated start of a later file, whose samples do not count again."""
    _connections: dict[int, int] = field(default_factory=dict)

    def replay(self, record: Record) -> None:
        if record.kind is Kind.EVENT:
            self._replay_event(record)
            return
        is_datagram = record.kind is Kind.DATAGRAM
        sender, data = record.datagram if is_datagram else ("", record.payload)
        samples = self.decoder.arrived(record.link, record.arrival_ns, data, sender).samples
        if self.is_repeated:
            return
        self.parts.append(samples)
        connection = self._connections.get(record.link, 0)
        self.epochs.append(np.full(len(samples), connection * _MOST_LINKS + record.link))

    def _replay_event(self, record: Record) -> None:
        event = record.event
        what = event.get("event")
        if what == "capture":
            self.is_repeated = bool(event.get("is_later"))
        elif what == BEGUN:
            self.is_repeated = False
            self.decoder.interrupted()
        elif what == "connected":
            device = str(event.get("device", ""))
            self.decoder.connected(record.link, record.arrival_ns, device)
            self._connections[record.link] = self._connections.get(record.link, 0) + 1
        elif what == "sites":
            self.config = self.decoder.set_sites(event["site_of"])
        elif what == "recording":
            self.begins_ns.append(record.arrival_ns)
        elif what == "recording_end":
            self.ends_ns[int(event["number"])] = record.arrival_ns


def recording_to_take(
    folder: str | os.PathLike[str],
    number: int | None = None,
    sites: tuple[str, ...] = (),
    site_of: Mapping[str, str] | None = None,
) -> RecordedTake:
    """Returns a recording of the capture in a folder, by default the last one.

    For a capture without a recording, returns everything. ``sites`` and ``site_of`` say where
    sensors are worn as in CaptureConfig, and win over what the capture was told. A sensor without
    a site is named by its identity. Raises RecordingError and OSError.
    """
    replay = _replayed(Path(folder), sites)
    decoder = replay.decoder
    decoder.set_sites(site_of or {})
    samples = np.concatenate([np.empty(0, SAMPLE), *replay.parts])
    epochs = np.concatenate([np.empty(0, np.int64), *replay.epochs])
    bounds_ns = _bounds(replay, folder, number)
    for index, sensor in enumerate(decoder.sensors):
        if sensor.replaced_by is not None:
            samples["sensor"][samples["sensor"] == index] = sensor.replaced_by
    where = decoder.sites
    tracks: dict[str, _SensorTrack] = {}
    for index in decoder.order:
        identity = decoder.sensors[index].identity
        own = (samples["sensor"] == index) & np.isfinite(samples["specific_force"]).all(axis=1)
        track = _track(samples[own], epochs[own], bounds_ns, identity)
        if len(track.times_s):
            tracks[where.name(index, identity)] = track
    if not tracks:
        raise RecordingError(f"{folder}: no samples were recorded; check ports and drivers")
    begin_s = min(float(track.times_s[0]) for track in tracks.values())
    gaps = [gap for site, track in tracks.items() for gap in _gaps(site, track.times_s - begin_s)]
    about = (
        f"recorded with {', '.join(dict.fromkeys(link.driver for link in replay.config.links))}",
        *(device_comment(name, track.identity) for name, track in tracks.items()),
        *(str(gap) for gap in gaps),
    )
    return RecordedTake(
        Take({site: track.record(begin_s) for site, track in tracks.items()}, about),
        tuple(gaps),
        tuple(track.identity for track in tracks.values()),
        where.conflicts,
        tuple(name for name in where.unknown if name in (site_of or {})),
        tuple(track.clock_rate for track in tracks.values()),
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
                replay.replay(record)
    except OSError:
        raise
    except LogFormatError as error:
        raise RecordingError(str(error)) from error
    except Exception as error:  # a log may contain anything
        raise RecordingError(
            f"{folder / FILE_NAME}: its content is not that of a capture "
            f"({type(error).__name__}); use the log that the capture wrote"
        ) from error
    if replay is None:
        raise RecordingError(f"{folder / FILE_NAME}: the log is empty; record again")
    return replay


def _bounds(replay: _Replay, folder: str | os.PathLike[str], number: int | None) -> tuple[int, int]:
    """Begin and end of the recording; one that was not stopped lasts until the end of the log."""
    no_end = np.iinfo(np.int64).max
    if number is None:
        if not replay.begins_ns:
            return 0, no_end
        number = len(replay.begins_ns) - 1
    if not 0 <= number < len(replay.begins_ns):
        raise RecordingError(f"{folder}: there is no recording {number}")
    return replay.begins_ns[number], replay.ends_ns.get(number, no_end)


@dataclass(frozen=True)
class _SensorTrack:
    """One sensor's samples in the recording."""

    identity: str
    times_s: Floats
    """On this machine's monotonic clock."""
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


def _track(
    samples: Samples, epochs: NDArray[np.int64], bounds_ns: tuple[int, int], identity: str
) -> _SensorTrack:
    """Estimates clocks from all samples of a sensor, and keeps those of the recording."""
    times_s, rate = np.empty(len(samples)), 1.0
    arrival_s = samples["arrival_ns"] * 1e-9
    order = np.argsort(samples["arrival_ns"], kind="stable")  # two ports may have had the sensor
    samples, epochs, arrival_s = samples[order], epochs[order], arrival_s[order]
    for epoch in np.unique(epochs):  # the device's clock may restart with each connection
        own = epochs == epoch
        times_s[own], rate = host_times(samples["device_time_s"][own], arrival_s[own])
    times_s = np.maximum.accumulate(times_s)
    is_in = (samples["arrival_ns"] >= bounds_ns[0]) & (samples["arrival_ns"] <= bounds_ns[1])
    return _SensorTrack(identity, times_s[is_in], samples[is_in], rate)


def _gaps(site: str, times_s: Floats) -> list[Gap]:
    steps = np.diff(times_s)
    return [
        Gap(site, float(times_s[i]), float(times_s[i + 1])) for i in np.flatnonzero(steps > GAP_S)
    ]
