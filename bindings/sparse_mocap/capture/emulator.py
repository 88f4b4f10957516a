# SPDX-License-Identifier: GPL-3.0-or-later
"""An emulator: pseudo-terminals that speak a device's protocol, fed from a take.

It is paced by absolute deadlines from the moment a host opens the port, and never waits for the
host: like a device's wire, what the host does not fetch is lost. Pseudo-terminals are POSIX's, so
this does not run on Windows.
"""

from __future__ import annotations

import errno
import os
import random
import select
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..take import Take
from .drivers import Encoder, can_share_a_port, with_rate
from .errors import CaptureError
from .sample_log import SAMPLE, Samples

__all__ = ["Emulator", "Faults", "Line", "instants", "period_s"]

_LONGEST_NAP_S = 0.05
_DRAIN_S = 2.0
_GREETING_S = 0.3
"""What a host asks a device before it lets it measure is asked within this time."""


@dataclass(frozen=True)
class Faults:
    """What goes wrong; times are in s of the take, and a pair is begin and length."""

    loss: float = 0.0
    """The part of packets that is never sent."""
    corruption: float = 0.0
    """The part of bytes that is changed on the way."""
    cut_after_s: float | None = None
    """The device is unplugged."""
    replug_after_s: float | None = None
    """It comes back so much later, as another pseudo-terminal."""
    stalls: tuple[tuple[float, float], ...] = ()
    """The device is silent, though plugged in."""
    resets_s: tuple[float, ...] = ()
    """The device starts anew: its counters and clock begin at 0."""
    garbage: tuple[tuple[float, float], ...] = ()
    """Random bytes come instead, as at a wrong baud rate."""
    is_id_duplicate: bool = False
    """The second sensor sends under the first one's id."""
    seed: int = 0


@dataclass
class Line:
    """One pseudo-terminal and the sensors behind it."""

    sensors: tuple[int, ...]
    encoder: Encoder
    link_path: Path | None = None
    master: int = -1
    path: str = ""

    def plug_in(self) -> None:
        """Makes the pseudo-terminal, raw, so that nothing is echoed or changed."""
        import tty

        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        os.close(slave)
        os.set_blocking(self.master, False)
        if self.link_path is not None:
            beside = self.link_path.with_name(f".{self.link_path.name}.{os.getpid()}")
            beside.symlink_to(self.path)
            beside.replace(self.link_path)

    def unplug(self) -> None:
        """Takes the pseudo-terminal away."""
        if self.master >= 0:
            os.close(self.master)
            self.master = -1
        if self.link_path is not None:
            self.link_path.unlink(missing_ok=True)

    def is_open(self) -> bool:
        """Whether a host has the port open."""
        if self.master < 0:
            return False
        poller = select.poll()
        poller.register(self.master, 0)
        return not any(event & select.POLLHUP for _, event in poller.poll(0))

    def send(self, data: bytes) -> bool:
        """Sends what the host has room for; returns False when that was not all."""
        if not self.is_open():  # a port that nobody has open keeps nothing for later
            return True
        try:
            return os.write(self.master, data) == len(data)
        except BlockingIOError:
            return False
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            return False

    def received(self) -> bytes:
        """What the host sent."""
        try:
            return os.read(self.master, 4096)
        except (BlockingIOError, OSError):
            return b""


@dataclass
class Emulator:
    """Plays a take to whoever opens its ports."""

    take: Take
    driver: str
    options: dict[str, str] = field(default_factory=dict)
    speed: float = 1.0
    faults: Faults = field(default_factory=Faults)
    link_path: Path | None = None
    """A symbolic link that is kept at the (first) pseudo-terminal."""

    begin_ns: int = 0
    """When the take's begin was played, on the machine's monotonic clock; 0: not yet."""
    is_done: bool = False
    """The whole take was played."""
    num_sent: int = 0
    num_overrun: int = 0
    """Packets that the host did not fetch in time."""

    def __post_init__(self) -> None:
        self._start_s = 0.0
        self._random = random.Random(self.faults.seed)
        count = len(self.take.sensors)
        groups: list[tuple[int, ...]] = [(index,) for index in range(count)]
        self._settings = with_rate(self.driver, self.options, 1.0 / period_s(self.take))
        if can_share_a_port(self.driver, self.take.sites, self._settings):
            groups = [tuple(range(count))]
        self.lines = [
            Line(sensors, self._new_encoder(sensors), self.link_path if index == 0 else None)
            for index, sensors in enumerate(groups)
        ]

    def plug_in(self) -> list[str]:
        """Makes the ports and returns their paths. Raises CaptureError where there are none."""
        if not hasattr(os, "openpty"):
            raise CaptureError("this system has no pseudo-terminals; emulate on Linux or macOS")
        for line in self.lines:
            line.plug_in()
        return [line.path for line in self.lines]

    def close(self) -> None:
        """Takes the ports away."""
        for line in self.lines:
            line.unplug()

    def run(
        self,
        must_end: Callable[[], bool] = lambda: False,
        replugged: Callable[[list[str]], None] = lambda paths: None,
    ) -> None:
        """Plays the take once, from the moment a host has opened every port."""
        if not self._wait(lambda: all(line.is_open() for line in self.lines), must_end):
            return
        due = instants(self.take)
        for line in self.lines:
            self._send(line, line.encoder.hello())
        self._until(time.monotonic_ns() + int(_GREETING_S * 1e9))
        self.begin_ns = time.monotonic_ns()
        pending = _Pending(self.faults)
        for time_s, samples in due:
            if must_end():
                return
            self._until(self.begin_ns + int(time_s / self.speed * 1e9))
            if not self._suffer(pending, time_s, must_end, replugged):
                return
            self._play(time_s, samples)
        self.is_done = True
        self._drain(must_end)

    def _play(self, time_s: float, samples: Samples) -> None:
        if _is_within(time_s, self.faults.stalls):
            return
        for line in self.lines:
            own = samples[np.isin(samples["sensor"], line.sensors)].copy()
            own["sensor"] -= line.sensors[0]
            if not len(own) or line.master < 0:
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
            self.num_overrun += not line.send(packet)

    def _corrupted(self, packet: bytes) -> bytes:
        return bytes(
            byte ^ (1 << self._random.randrange(8))
            if self._random.random() < self.faults.corruption
            else byte
            for byte in packet
        )

    def _suffer(
        self,
        pending: _Pending,
        time_s: float,
        must_end: Callable[[], bool],
        replugged: Callable[[list[str]], None],
    ) -> bool:
        """Does what goes wrong now, and returns whether the take goes on."""
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
            if line.master >= 0:
                self._send(line, line.encoder.hello())

    def _new_encoder(self, sensors: Sequence[int]) -> Encoder:
        return Encoder(self.driver, [self.take.sites[index] for index in sensors], self._settings)

    def _until(self, deadline_ns: int) -> None:
        while True:
            self._answer()
            rest_s = (deadline_ns - time.monotonic_ns()) * 1e-9
            if rest_s <= 0.0:
                return
            time.sleep(min(rest_s, _LONGEST_NAP_S))

    def _answer(self) -> None:
        for line in self.lines:
            if line.master >= 0 and (asked := line.received()):
                answer = line.encoder.respond(asked)
                if answer:
                    line.send(answer)

    def _wait(self, is_so: Callable[[], bool], must_end: Callable[[], bool]) -> bool:
        while not is_so():
            if must_end():
                return False
            time.sleep(0.01)
        return True

    def _drain(self, must_end: Callable[[], bool]) -> None:
        """Leaves the host time to fetch the last bytes: closing takes them away."""
        end = time.monotonic() + _DRAIN_S
        while time.monotonic() < end and not must_end():
            if not any(line.is_open() for line in self.lines):
                return
            self._answer()
            time.sleep(0.02)


@dataclass
class _Pending:
    """The faults of an instant that are still to come."""

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
    """The time between two samples of the take's fastest sensor."""
    steps = [np.median(np.diff(r.times_s)) for r in take.sensors.values() if len(r.times_s) > 1]
    return float(min(steps, default=0.01))


def instants(take: Take) -> list[tuple[float, Samples]]:
    """The take's samples by when they are due, those of one sampling period together."""
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
