# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sensor is which: by the device's own identity, in whatever order and wherever it sends."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap.capture import CaptureConfig, LinkConfig, recording_to_take
from sparse_mocap.capture.decoder import MOVED_S
from sparse_mocap.capture.raw_log import RawLogWriter
from sparse_mocap.capture.remembered_sites import remember_sites, remembered_sites, sites_path
from sparse_mocap.capture.sample_log import SAMPLE
from sparse_mocap.capture.shaking import ShakeFinder
from trackers_support import adapters_are_on_their_limbs, are_on_their_limbs

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
MACS = [bytes([0x24, 0xE6, 0xA1, 0, 0, number]) for number in range(4)]
ORDERS = list(itertools.permutations(range(4)))
STEP_NS = 10_000_000
SETTINGS = {"columns": "time,ax,ay,az", "time_unit": "us"}


def text_of(mac: bytes) -> str:
    return mac.hex(":")


class Log:
    """A capture's log, written record by record with times of its own."""

    def __init__(self, folder: Path, config: CaptureConfig) -> None:
        self._writer = RawLogWriter(folder)
        self.now_ns = 1_000_000_000
        self.event(0, {"event": "capture", "config": config.as_json(), "unix_s": 1.0})

    def event(self, link: int, event: dict[str, object]) -> None:
        self._writer.append_event(link, self.now_ns, event)

    def connect(self, link: int, port: str, device: str = "") -> None:
        self.event(link, {"event": "connected", "port": port, "device": device})

    def datagram(self, sender: str, data: bytes) -> None:
        self._writer.append_datagram(0, self.now_ns, sender, data)

    def bytes(self, link: int, data: bytes) -> None:
        self._writer.append_bytes(link, self.now_ns, data)

    def close(self) -> None:
        self._writer.close()


class Tracker:
    """A SlimeVR tracker; its acceleration along x says which it is."""

    def __init__(self, number: int) -> None:
        self.number, self.packet = number, 0

    def greeting(self) -> bytes:
        return (
            struct.pack(">iq", 3, 0) + struct.pack(">7i", *[0] * 6, 22) + b"\0" + MACS[self.number]
        )

    def sample(self) -> Iterator[bytes]:
        self.packet += 2
        yield struct.pack(">iq2B4fB", 17, self.packet, 0, 1, 0, 0, 0, 1, 0)
        yield struct.pack(">iq3fB", 4, self.packet + 1, self.number + 1.0, 0, 0, 0)


def trackers_started(folder: Path, order: Sequence[int], config: CaptureConfig) -> None:
    """They start in an order, and the first of them is replugged under another address."""
    log = Log(folder, config)
    log.connect(0, "udp://0.0.0.0:6969")
    running: list[tuple[str, Tracker]] = []
    for place, number in enumerate([*order, order[0]]):
        tracker = Tracker(number)
        running = [own for own in running if own[1].number != number]
        sender = f"10.0.0.{50 + place}:{40_000 + place}"
        running.append((sender, tracker))
        log.datagram(sender, tracker.greeting())
        for _ in range(20):
            log.now_ns += STEP_NS
            for own_sender, own in running:
                for data in own.sample():
                    log.datagram(own_sender, data)
    log.close()


@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "".join(map(str, order)))
def test_trackers_are_on_their_limbs_in_whatever_order_they_start(
    tmp_path: Path, order: Sequence[int]
) -> None:
    site_of = {text_of(mac): site for mac, site in zip(MACS, SITES, strict=True)}
    config = CaptureConfig((LinkConfig("udp://0.0.0.0:6969", "slimevr"),), site_of=site_of)
    trackers_started(tmp_path, order, config)
    recorded = recording_to_take(tmp_path)
    assert recorded.warnings == []
    assert sorted(recorded.take.sites) == sorted(SITES)
    for number, site in enumerate(SITES):
        record = recorded.take.sensors[site]
        assert record.specific_force[:, 0] == pytest.approx(number + 1.0, abs=1e-5)
        assert len(record.times_s) == 20 * (5 - order.index(number))


def lines(number: int, begin: int, count: int) -> bytes:
    steps = range(begin, begin + count)
    return "".join(f"{10_000 * i},{number + 1},0,9.81\r\n" for i in steps).encode()


@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "".join(map(str, order)))
def test_sensors_on_ports_are_known_by_their_adapters_numbers(
    tmp_path: Path, order: Sequence[int]
) -> None:
    """Devices without an identity of their own; the ports' names depend on the order."""
    site_of = {f"SERIAL{number}": site for number, site in enumerate(SITES)}
    links = tuple(LinkConfig(f"/dev/ttyUSB{i}", "text_line", options=SETTINGS) for i in range(4))
    log = Log(tmp_path, CaptureConfig(links, site_of=site_of))
    for link, number in enumerate(order):
        log.connect(link, f"/dev/ttyUSB{link}", f"SERIAL{number}")
        log.now_ns += 300_000_000
        log.bytes(link, lines(number, 0, 30))
    log.now_ns += 2_000_000_000
    log.connect(0, "/dev/ttyUSB7", f"SERIAL{order[0]}")  # replugged
    log.now_ns += 300_000_000
    log.bytes(0, lines(order[0], 0, 30))
    log.close()
    take = recording_to_take(tmp_path).take
    assert sorted(take.sites) == sorted(SITES)
    for number, site in enumerate(SITES):
        assert take.sensors[site].specific_force[:, 0] == pytest.approx(number + 1.0)


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 1, 0, 2)])
def test_real_ports_and_sockets_do_the_same(tmp_path: Path, order: Sequence[int]) -> None:
    """`./dev endure order` does so in every order."""
    assert are_on_their_limbs(tmp_path / "udp", order)
    assert adapters_are_on_their_limbs(tmp_path / "usb", order)


def test_a_device_that_moved_to_another_port_is_the_same_sensor(tmp_path: Path) -> None:
    options = {"columns": "sensor,ax,ay,az"}
    links = tuple(LinkConfig(f"/dev/ttyUSB{i}", "text_line", options=options) for i in range(2))
    log = Log(tmp_path, CaptureConfig(links, site_of={"A7": "head"}))
    for link in range(2):
        log.connect(link, f"/dev/ttyUSB{link}")
        log.now_ns += int(MOVED_S * 1.5e9)
        for _ in range(20):
            log.now_ns += STEP_NS
            log.bytes(link, f"A7,{link},0,9.81\n".encode())
    log.close()
    recorded = recording_to_take(tmp_path)
    assert recorded.take.sites == ["head"]
    assert len(recorded.take.sensors["head"].times_s) == 40


def test_two_devices_with_one_identity_are_told_and_both_recorded(tmp_path: Path) -> None:
    options = {"columns": "sensor,ax,ay,az"}
    links = tuple(LinkConfig(f"/dev/ttyUSB{i}", "text_line", options=options) for i in range(2))
    log = Log(tmp_path, CaptureConfig(links))
    for link in range(2):
        log.connect(link, f"/dev/ttyUSB{link}")
    log.now_ns += 300_000_000
    for _ in range(20):
        log.now_ns += STEP_NS
        for link in range(2):
            log.bytes(link, b"A7,0,0,9.81\n")
    log.close()
    assert recording_to_take(tmp_path).take.sites == ["A7", "A7 at /dev/ttyUSB1"]


def test_two_sensors_at_one_site_are_told_and_neither_is_lost(tmp_path: Path) -> None:
    site_of = {text_of(MACS[0]): "head", text_of(MACS[1]): "head"}
    config = CaptureConfig((LinkConfig("udp://0.0.0.0:6969", "slimevr"),), site_of=site_of)
    trackers_started(tmp_path, range(4), config)
    recorded = recording_to_take(tmp_path, site_of={"nobody": "pelvis"})
    assert recorded.take.sites == [text_of(mac) for mac in MACS]
    told = "\n".join(recorded.warnings)
    assert f"{text_of(MACS[0])} and {text_of(MACS[1])} are both worn at head" in told
    assert "there is no sensor 'nobody'" in told
    again = recording_to_take(tmp_path, site_of={text_of(MACS[1]): "chest"})
    assert again.take.sites[:2] == ["head", "chest"]


def test_a_list_of_sites_is_by_identity_too(tmp_path: Path) -> None:
    for number, order in enumerate([(0, 1, 2, 3), (3, 1, 0, 2)]):
        folder = tmp_path / str(number)
        folder.mkdir()
        config = CaptureConfig((LinkConfig("udp://0.0.0.0:6969", "slimevr"),), SITES)
        trackers_started(folder, order, config)
        take = recording_to_take(folder).take
        for own, site in enumerate(SITES):
            assert take.sensors[site].specific_force[:, 0] == pytest.approx(own + 1.0, abs=1e-5)


def test_sites_are_remembered_by_identity() -> None:
    remember_sites({"A": "head", "B": "chest"})
    remember_sites({"A": "pelvis", "B": ""})
    assert remembered_sites() == {"A": "pelvis"}
    for text in (
        "",
        "[",
        "[]",
        '{"format": "x"}',
        '{"format": "sparse_mocap_sensors", "sites": 3}',
    ):
        sites_path().write_text(text)
        assert remembered_sites() == {}


def samples(count: int, shaken: int, size: float) -> np.ndarray:
    times = np.repeat(np.arange(count), 3)
    found = np.zeros(3 * count, SAMPLE)
    found["sensor"] = np.tile([0, 1, 2], count)
    found["arrival_ns"] = times * STEP_NS
    found["specific_force"] = [0.0, 0.0, 9.81]
    is_shaken = found["sensor"] == shaken
    found["specific_force"][is_shaken, 0] = size * np.sin(times[is_shaken])
    return found


@pytest.mark.parametrize(("size", "expected"), [(20.0, 1), (1.0, None)])
def test_the_sensor_that_is_shaken_is_found(size: float, expected: int | None) -> None:
    finder = ShakeFinder()
    found = [finder.push(part) for part in np.array_split(samples(100, 1, size), 20)]
    assert found[-1] == expected
    both = samples(100, 1, size)
    both["specific_force"][both["sensor"] == 2] = both["specific_force"][both["sensor"] == 1]
    assert ShakeFinder().push(both) is None
