# SPDX-License-Identifier: GPL-3.0-or-later
"""Emulates devices: plays a take in a device's protocol.

Packets are sent at absolute times, counted from the moment a host opens the port, without waiting
for the host: as with a real device, what the host does not read in time is lost.
"""

from __future__ import annotations

import os
import random
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..take import Take
from .drivers import Encoder, can_share_a_port, with_rate
from .emulated_port import EmulatedPort, PseudoTerminal, TcpPort
from .sample_log import SAMPLE, Samples

__all__ = ["Emulator", "Faults", "Line", "instants", "period_s"]

_LONGEST_SLEEP_S = 0.05
_DRAIN_S = 2.0
_GREETING_S = 0.3
"""Time for the commands that a host sends before measuring."""


@dataclass(frozen=True)
class Faults:
    """Faults to emulate; times are in s of the take, a pair is begin and duration."""

    loss: float = 0.0
    """Fraction of packets that are not sent."""
    corruption: float = 0.0
    """Fraction of bytes that are changed."""
    cut_after_s: float | None = None
    """The device is unplugged."""
    replug_after_s: float | None = None
    """It is plugged in again this much later, as another pseudo-terminal."""
    stalls: tuple[tuple[float, float], ...] = ()
    """The device sends nothing, though plugged in."""
    resets_s: tuple[float, ...] = ()
    """The device restarts: its counters and clock start at 0."""
    garbage: tuple[tuple[float, float], ...] = ()
    """Random bytes are sent instead, as with a wrong baud rate."""
    is_id_duplicate: bool = False
    """The second sensor sends with the first one's id."""
    seed: int = 0


@dataclass
class Line:
    """One port and its sensors."""

    sensors: tuple[int, ...]
    encoder: Encoder
    port: EmulatedPort
    path: str = ""
    """The name by which a host opens the port."""


@dataclass
class Emulator:
    """Plays a take to the host that opens its ports."""

    take: Take
    driver: str
    options: dict[str, str] = field(default_factory=dict)
    speed: float = 1.0
    faults: Faults = field(default_factory=Faults)
    link_path: Path | None = None
    """A symbolic link to the (first) pseudo-terminal, kept up to date."""
    over_tcp: bool = not hasattr(os, "openpty")
    """Ports are pseudo-terminals, or TCP ports of this machine."""

    begin_ns: int = 0
    """When the take's begin was sent, on this machine's monotonic clock; 0: not yet."""
    is_done: bool = False
    """The whole take was played."""
    num_sent: int = 0
    num_overrun: int = 0
    """Packets that the host did not read in time."""

    def __post_init__(self) -> None:
        self._start_s = 0.0
        self._random = random.Random(self.faults.seed)
        count = len(self.take.sensors)
        groups: list[tuple[int, ...]] = [(index,) for index in range(count)]
        self._settings = with_rate(self.driver, self.options, 1.0 / period_s(self.take))
        if can_share_a_port(self.driver, self.take.sites, self._settings):
            groups = [tuple(range(count))]
        kind = TcpPort if self.over_tcp else PseudoTerminal
        self.lines = [
            Line(
                sensors,
                self._new_encoder(sensors),
                kind(self.link_path if index == 0 else None),
            )
            for index, sensors in enumerate(groups)
        ]

    def plug_in(self) -> list[str]:
        """Creates the ports and returns their paths, or URLs of TCP ports."""
        for line in self.lines:
            line.path = line.port.plug_in()
        return [line.path for line in self.lines]

    def close(self) -> None:
        """Removes the ports."""
        for line in self.lines:
            line.port.unplug()

    def run(
        self,
        must_end: Callable[[], bool] = lambda: False,
        replugged: Callable[[list[str]], None] = lambda paths: None,
    ) -> None:
        """Plays the take once, as soon as a host has opened every port."""
        if not self._wait(lambda: all(line.port.is_open() for line in self.lines), must_end):
            return
        due = self.schedule()
        for line in self.lines:
            self._send(line, line.encoder.hello())
        self._until(time.perf_counter_ns() + int(_GREETING_S * 1e9))
        self.begin_ns = time.perf_counter_ns()
        pending = _Pending(self.faults)
        for time_s, samples in due:
            if must_end():
                return
            self._until(self.begin_ns + int(time_s / self.speed * 1e9))
            if not self._apply_faults(pending, time_s, must_end, replugged):
                return
            self._play(time_s, samples)
        self.is_done = True
        self._drain(must_end)

    def schedule(self) -> Iterable[tuple[float, Samples]]:
        """What is sent, and when in s since the take's begin."""
        return instants(self.take)

    def _play(self, time_s: float, samples: Samples) -> None:
        if _is_within(time_s, self.faults.stalls):
            return
        for line in self.lines:
            own = samples[np.isin(samples["sensor"], line.sensors)].copy()
            own["sensor"] -= line.sensors[0]
            if not len(own) or not line.port.is_plugged_in:
                continue
            if _is_within(time_s, self.faults.garbage):
                self._send(line, [self._random.randbytes(32 * len(own))])
                continue
            for part in self._duplicated(own):
                self._send(line, line.encoder.encode(time_s - self._start_s, part))

    def _duplicated(self, samples: Samples) -> list[Samples]:
        if not self.faults.is_id_duplicate:
            return [samples]
        second = samples[samples["sensor"] == 1].copy()
        second["sensor"] = 0
        return [samples[samples["sensor"] != 1], second] if len(second) else [samples]

    def _send(self, line: Line, packets: Sequence[bytes]) -> None:
        for packet in packets:
            if self._random.random() < self.faults.loss:
                continue
            if self.faults.corruption > 0.0:
                packet = self._corrupted(packet)
            self.num_sent += 1
            self.num_overrun += not line.port.send(packet)

    def _corrupted(self, packet: bytes) -> bytes:
        return bytes(
            byte ^ (1 << self._random.randrange(8))
            if self._random.random() < self.faults.corruption
            else byte
            for byte in packet
        )

    def _apply_faults(
        self,
        pending: _Pending,
        time_s: float,
        must_end: Callable[[], bool],
        replugged: Callable[[list[str]], None],
    ) -> bool:
        """Applies the faults that are due; returns whether to continue."""
        if pending.is_reset_due(time_s):
            self._restart(time_s)
        if pending.is_cut_due(time_s):
            self.close()
            if self.faults.replug_after_s is None:
                return False
        if pending.is_replug_due(time_s):
            replugged(self.plug_in())
            self._restart(time_s)
        return not must_end()

    def _restart(self, time_s: float) -> None:
        self._start_s = time_s
        for line in self.lines:
            line.encoder = self._new_encoder(line.sensors)
            if line.port.is_plugged_in:
                self._send(line, line.encoder.hello())

    def _new_encoder(self, sensors: Sequence[int]) -> Encoder:
        return Encoder(self.driver, [self.take.sites[index] for index in sensors], self._settings)

    def _until(self, deadline_ns: int) -> None:
        while True:
            self._answer()
            rest_s = (deadline_ns - time.perf_counter_ns()) * 1e-9
            if rest_s <= 0.0:
                return
            time.sleep(min(rest_s, _LONGEST_SLEEP_S))

    def _answer(self) -> None:
        for line in self.lines:
            if line.port.is_plugged_in and (request := line.port.received()):
                answer = line.encoder.respond(request)
                if answer:
                    line.port.send(answer)

    def _wait(self, is_so: Callable[[], bool], must_end: Callable[[], bool]) -> bool:
        while not is_so():
            if must_end():
                return False
            time.sleep(0.01)
        return True

    def _drain(self, must_end: Callable[[], bool]) -> None:
        """Gives the host time to read the last bytes, which closing would discard."""
        end = time.perf_counter() + _DRAIN_S
        while time.perf_counter() < end and not must_end():
            if not any(line.port.is_open() for line in self.lines):
                return
            self._answer()
            time.sleep(0.02)


@dataclass
class _Pending:
    """The faults that are still to come."""

    faults: Faults
    num_resets: int = 0
    is_cut: bool = False
    is_back: bool = False

    def is_reset_due(self, time_s: float) -> bool:
        due = sum(time_s >= at for at in self.faults.resets_s)
        is_due = due > self.num_resets
        self.num_resets = due
        return is_due

    def is_cut_due(self, time_s: float) -> bool:
        at = self.faults.cut_after_s
        is_due = at is not None and not self.is_cut and time_s >= at
        self.is_cut |= is_due
        return is_due

    def is_replug_due(self, time_s: float) -> bool:
        at, later = self.faults.cut_after_s, self.faults.replug_after_s
        is_due = self.is_cut and not self.is_back and at is not None and later is not None
        is_due = is_due and time_s >= at + later  # type: ignore[operator]
        self.is_back |= is_due
        return is_due


def _is_within(time_s: float, spans: Sequence[tuple[float, float]]) -> bool:
    return any(begin <= time_s < begin + length for begin, length in spans)


def period_s(take: Take) -> float:
    """The sampling period of the take's fastest sensor."""
    steps = [np.median(np.diff(r.times_s)) for r in take.sensors.values() if len(r.times_s) > 1]
    return float(min(steps, default=0.01))


def instants(take: Take) -> list[tuple[float, Samples]]:
    """The take's samples in order of time, grouped by sampling period."""
    parts = []
    for index, record in enumerate(take.sensors.values()):
        part = np.zeros(len(record.times_s), SAMPLE)
        part["sensor"], part["counter"] = index, -1
        part["device_time_s"] = record.times_s - take.begin_s
        part["specific_force"] = record.specific_force
        for name, values in (
            ("angular_velocity", record.angular_velocity),
            ("orientation", record.orientation),
        ):
            part[name] = np.nan if values is None else values
        parts.append(part)
    samples = np.concatenate(parts)
    slots: NDArray[np.int64] = np.rint(samples["device_time_s"] / period_s(take)).astype(np.int64)
    order = np.lexsort((samples["device_time_s"], samples["sensor"], slots))
    samples, slots = samples[order], slots[order]
    is_again = (np.diff(slots, prepend=-1) == 0) & (np.diff(samples["sensor"], prepend=-1) == 0)
    order = np.lexsort((samples["sensor"], is_again, slots))
    samples, keys = samples[order], 2 * slots[order] + is_again[order]
    groups = np.split(samples, np.flatnonzero(np.diff(keys)) + 1)
    return [(float(group["device_time_s"].max()), group) for group in groups]
