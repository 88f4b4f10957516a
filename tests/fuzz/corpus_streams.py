# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the first inputs of the streams' fuzzer: a short stream of each driver.

``python tests/fuzz/corpus_streams.py FOLDER``; the settings are in the order of streams.cpp.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from sparse_mocap import StreamEncoder

SETTINGS: list[tuple[str, dict[str, object]]] = [
    ("xsens_mt", {}),
    ("xsens_mt", {"output": "mtdata"}),
    ("witmotion", {}),
    ("witmotion_ble", {}),
    ("ximu3", {"format": "binary"}),
    ("text_line", {"columns": "time,ax,ay,az,gx,gy,gz,qw,qx,qy,qz"}),
    ("text_line", {"columns": "header"}),
    ("slimevr", {}),
]


def stream(driver: str, options: dict[str, object], num: int) -> bytes:
    """The bytes of a few samples at rest."""
    device = StreamEncoder(driver, ["one"], **options)
    packets = [device.respond(b"\xfa\xff\x0c\x00\xf5")] if driver == "xsens_mt" else []
    packets += device.hello()
    force, turn, orientation = np.array([[0.1, -2.0, 9.81]]), np.ones((1, 3)), np.eye(4)[:1]
    for i in range(num):
        packets += device.encode(1.0 + 0.01 * i, i, force, turn, orientation)
    if driver == "slimevr":
        packets = [len(packet).to_bytes(2, "big") + packet for packet in packets]
    return b"".join(packets)


def main(folder: Path) -> None:
    """Writes a file for each setting."""
    for index, (driver, options) in enumerate(SETTINGS):
        data = bytes([index, 5 + index]) + stream(driver, options, 4)
        (folder / f"{index}_{driver}").write_bytes(data)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
