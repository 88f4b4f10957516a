# SPDX-License-Identifier: GPL-3.0-or-later
"""Captures for a long time, and captures that are killed; prints what it measured.

    ./dev endure                   # all, 25 minutes
    ./dev endure steady [SECONDS]  # default 600
    ./dev endure kill [TIMES]      # default 100
    ./dev endure replug [TIMES]    # default 20
    ./dev endure silence [SECONDS] # default 10: the longest silence
    ./dev endure order [TIMES]     # default 4: each of the 24 orders so often

`steady`: six sensors at 200 Hz from an emulator in a process of its own. A client stalls for 5 s
now and then, and is replaced by another. Counted: samples lost on the way, samples that the clients
missed, the worst error of a sample's time against the emulator's deadline.

`kill`: SIGKILL to the capture or to its client at random moments. Counted: samples that the capture
had told of and that cannot be read afterwards, holes, and processes, session files or locks of
ports left behind.

`replug`: the device is unplugged and comes back as another pseudo-terminal. Measured: how long it
takes from its return to its first sample.

`silence`: with each driver, the device sends nothing for 0.1 s to that long, restarts, and is
played again from the start. Measured: how long it takes from the return of the data until live
readings are true, and how far the take's length is off the wall clock, at worst.

`order`: four trackers over UDP start in each order, and one comes back from another address; the
same with four devices on USB adapters, one of which is replugged as another port. Counted: takes in
which one is not on its limb.
"""

from __future__ import annotations

import itertools
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python" / "capture"))

from capture_support import SITES, some_take
from silence_support import DRIVERS, silence
from sparse_mocap.capture import (
    CaptureClient,
    CaptureConfig,
    Emulator,
    Faults,
    LinkConfig,
    PortError,
    RecordedTake,
    recording_to_take,
    start_capture,
)
from sparse_mocap.capture.ports import open_port
from sparse_mocap.capture.session import FOLDER_VARIABLE, runtime_folder, sessions
from trackers_support import adapters_are_on_their_limbs, are_on_their_limbs

DRIVER, NUM_SENSORS, RATE_HZ = "xsens_mt", 6, 200.0
OPTIONS = {"output": "mtdata", "num_sensors": str(NUM_SENSORS), "rate_hz": f"{RATE_HZ:g}"}


def emulate(seconds: float, link: str, faults: Faults | None = None) -> None:
    """The other process: plays, and says when it began."""
    emulator = Emulator(
        some_take(seconds, NUM_SENSORS, RATE_HZ), DRIVER, dict(OPTIONS),
        faults=faults or Faults(), link_path=Path(link),
    )  # fmt: skip
    print(*emulator.plug_in(), flush=True)
    returns: list[int] = []
    emulator.run(replugged=lambda paths: returns.append(time.perf_counter_ns()))
    emulator.close()
    print(json.dumps([emulator.begin_ns, emulator.num_overrun, returns]), flush=True)


class Device:
    """An emulator in a process of its own."""

    def __init__(self, seconds: float, link: Path, *fault: float) -> None:
        arguments = ["emulate", str(seconds), str(link), *map(str, fault)]
        self.process = subprocess.Popen(
            [sys.executable, __file__, *arguments], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.path = self.process.stdout.readline().strip()

    def told(self) -> tuple[int, int, list[int]]:
        """When it began, what was not fetched in time, and when it came back."""
        assert self.process.stdout is not None
        begin_ns, num_overrun, returns = json.loads(self.process.stdout.readline())
        self.process.wait()
        return begin_ns, num_overrun, returns


def config_of(port: str) -> CaptureConfig:
    return CaptureConfig((LinkConfig(port, DRIVER, options=OPTIONS),), SITES, must_record=True)


def worst_error_s(recorded: RecordedTake, begin_ns: int) -> float:
    """Of the samples' times against the emulator's deadlines."""
    taken_s = np.arange(10_000_000) / RATE_HZ
    worst = 0.0
    for record in recorded.take.sensors.values():
        times = record.times_s + (recorded.begin_ns - begin_ns) * 1e-9
        nearest = taken_s[np.rint(times * RATE_HZ).astype(int)]
        worst = max(worst, float(abs(times - nearest).max()))
    return worst


def memory_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def cpu_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def steady(folder: Path, seconds: float) -> dict[str, Any]:
    device = Device(seconds, folder / "port")
    client = start_capture(config_of(device.path), folder / "c")
    pid, num_read = client.session.pid, 0
    chance = random.Random(1)
    next_stall = time.perf_counter() + 5.0
    used: dict[str, float] = {}
    expected = round(seconds * RATE_HZ) * NUM_SENSORS
    while device.process.poll() is None and num_read < expected:
        num_read += len(client.read())
        used = {"memory_mb": memory_mb(pid), "cpu_s": cpu_s(pid)}
        if time.perf_counter() > next_stall:
            time.sleep(5.0)
            next_stall = time.perf_counter() + chance.uniform(5.0, 60.0)
            position, session = client.position, client.session
            client.close()
            client = CaptureClient(session, position)
        time.sleep(0.02)
    num_read += len(client.read())
    status = client.status()
    client.stop()
    begin_ns, num_overrun, _ = device.told()
    recorded = recording_to_take(folder / "c")
    kept = sum(len(record.times_s) for record in recorded.take.sensors.values())
    return {
        "expected": expected, "kept": kept, "lost": expected - kept,
        "before_the_first_s": (recorded.begin_ns - begin_ns) * 1e-9,
        "missed_by_clients": status["samples"] - num_read, "not_fetched_in_time": num_overrun,
        "missing_by_counter": recorded.num_missing,
        "worst_time_error_ms": 1e3 * worst_error_s(recorded, begin_ns),
        "gaps": len(recorded.gaps), "reconnects": status["links"][0]["reconnects"], **used,
    }  # fmt: skip


CONSUMER = """
import sys, time
from sparse_mocap.capture import CaptureClient
from sparse_mocap.capture.session import sessions
client = CaptureClient(sessions()[0], 0)
print("on", flush=True)
while True:
    client.read()
    time.sleep(0.01)
"""


def kill(folder: Path, times: int) -> dict[str, Any]:
    chance = random.Random(2)
    sent = some_take(30.0, NUM_SENSORS, RATE_HZ).sensors
    unreadable = holes = wrong = left = 0
    counts = {"capture": 0, "consumer": 0}
    for number in range(times):
        device = Device(30.0, folder / "port")
        where = folder / f"c{number}"
        client = start_capture(config_of(device.path), where)
        victim = ("capture", "consumer")[number % 2]
        counts[victim] += 1
        told = _killed(client, victim, chance.uniform(0.4, 1.5))
        left += not _is_free(device.path)
        device.process.kill()
        device.process.wait()
        recorded = recording_to_take(where)
        kept = sum(len(record.times_s) for record in recorded.take.sensors.values())
        unreadable += max(0, told - kept)
        holes += recorded.num_missing
        for site, record in recorded.take.sensors.items():
            own = record.specific_force
            wrong += int(abs(own - sent[site].specific_force[: len(own)]).max() > 1e-3)
        left += len(sessions()) + len(list(runtime_folder().iterdir()))
        left += Path(f"/proc/{client.session.pid}").exists()
    return {**counts, "unreadable": unreadable, "holes": holes, "wrong": wrong, "left": left}


def _is_free(port: str) -> bool:
    """Whether nobody holds the port."""
    try:
        open_port(port, 115200).close()
    except PortError:
        return False
    return True


def _killed(client: CaptureClient, victim: str, after_s: float) -> int:
    """Kills, and returns how many samples the capture had told of."""
    consumer = subprocess.Popen([sys.executable, "-c", CONSUMER], stdout=subprocess.PIPE, text=True)
    assert consumer.stdout is not None
    consumer.stdout.readline()
    client.wait_for_samples(20.0)
    time.sleep(after_s)
    told = int(client.status()["samples"])
    if victim == "capture":
        os.kill(client.session.pid, signal.SIGKILL)
        consumer.kill()
    else:
        consumer.kill()
        time.sleep(0.2)
        told = int(client.status()["samples"])
        client.stop()
    consumer.wait()
    consumer.stdout.close()
    client.close()
    with suppress(ChildProcessError):
        os.waitpid(client.session.pid, 0)
    return told


def replug(folder: Path, times: int) -> dict[str, Any]:
    chance = random.Random(3)
    late_s, num_gaps = [], 0
    for number in range(times):
        device = Device(9.0, folder / "port", 2.0, chance.uniform(0.1, 4.0))
        where = folder / f"c{number}"
        client = start_capture(config_of(str(folder / "port")), where)
        time.sleep(9.5)
        client.stop()
        _, _, (back_ns,) = device.told()
        recorded = recording_to_take(where)
        num_gaps += len(recorded.gaps) == NUM_SENSORS
        late_s.append(recorded.gaps[0].end_s + (recorded.begin_ns - back_ns) * 1e-9)
    return {
        "times": times, "gaps_told": num_gaps, "median_s": float(np.median(late_s)),
        "worst_s": max(late_s),
    }  # fmt: skip


def silences(folder: Path, longest_s: int) -> dict[str, Any]:
    told: dict[str, Any] = {}
    lengths = [length for length in (0.1, 0.3, 1.0, 3.0, 10.0) if length <= longest_s]
    for driver in DRIVERS:
        stalls, at = [], 2.0
        for length in lengths:
            stalls.append((at, length))
            at += length + 2.0
        found = [
            silence(folder, driver, at + 1.0, Faults(stalls=tuple(stalls))),
            silence(folder, driver, 6.0, Faults(resets_s=(2.0, 4.0))),
            silence(folder, driver, 4.0, Faults(), plays=3),
            silence(folder, driver, 8.0, Faults(cut_after_s=2.0, replug_after_s=1.0)),
        ]
        told[driver] = {
            "back_s": [round(one.back_s, 3) for one in found],
            "length_error_percent": [round(100 * one.length_error, 3) for one in found],
            "false_readings": [one.num_false for one in found],
        }
    return told


def order(folder: Path, times: int) -> dict[str, Any]:
    wrong = 0
    orders = list(itertools.permutations(range(4)))
    for number, starts in enumerate(orders * times):
        wrong += not are_on_their_limbs(folder / f"udp{number}", starts)
        wrong += not adapters_are_on_their_limbs(folder / f"usb{number}", starts)
    return {"takes": 2 * len(orders) * times, "wrong": wrong}


PROOFS = {
    "steady": (steady, 600), "kill": (kill, 100), "replug": (replug, 20),
    "silence": (silences, 10), "order": (order, 4),
}  # fmt: skip


def main(arguments: list[str]) -> None:
    what, *rest = arguments or ["all"]
    if what == "emulate":
        seconds, link, *fault = rest
        faults = (
            Faults(cut_after_s=float(fault[0]), replug_after_s=float(fault[1])) if fault else None
        )
        emulate(float(seconds), link, faults)
        return
    if what != "all" and what not in PROOFS:
        raise SystemExit(__doc__)
    for name in PROOFS if what == "all" else (what,):
        proof, usual = PROOFS[name]
        with tempfile.TemporaryDirectory(prefix="sparse-mocap-endurance-") as folder:
            os.environ[FOLDER_VARIABLE] = str(Path(folder) / "runtime")
            told = proof(Path(folder), int(rest[0]) if rest else usual)
        load = [round(value, 1) for value in os.getloadavg()]
        print(name, json.dumps({**told, "load": load}, indent=2), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
