# SPDX-License-Identifier: GPL-3.0-or-later
"""From bytes to samples over all links of a capture."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from capture_support import DRIVER, OPTIONS
from sparse_mocap import StreamParser, driver_names
from sparse_mocap.capture import CaptureConfig, LinkConfig
from sparse_mocap.capture.decoder import IDLE_S, Decoder


def test_the_first_line_counts_when_the_wire_was_idle_before_it() -> None:
    link = LinkConfig("port", "text_line", options={"columns": "ax,ay,az"})
    for idle_s, num_samples in ((0.5 * IDLE_S, 1), (1.5 * IDLE_S, 2)):
        decoder = Decoder(CaptureConfig((link,)))
        decoder.connected(0, 10**9)
        came = decoder.arrived(0, 10**9 + int(idle_s * 1e9), b"0,0,9\r\n0,0,8\r\n")
        assert len(came.samples) == num_samples


def test_a_device_that_starts_anew_is_configured_anew() -> None:
    decoder = Decoder(CaptureConfig((LinkConfig("port", DRIVER, options=OPTIONS),)))
    commands = decoder.connected(0, 0)
    woke_up = bytes.fromhex("FAFF3E00C3")
    assert decoder.arrived(0, 1, woke_up[:3]).replies == ()
    replies = decoder.arrived(0, 2, woke_up[3:]).replies
    assert replies[-len(commands) :] == commands
    assert commands[-1] == bytes.fromhex("FAFF1000F1")  # measure
    assert decoder.arrived(0, 3, b"\x00" * 50).replies == ()


@pytest.mark.skipif(sys.platform != "linux", reason="reads Linux' /proc")
@pytest.mark.parametrize("driver", driver_names())
def test_noise_takes_no_memory(driver: str) -> None:
    source = np.random.default_rng(1)
    parser = StreamParser(driver)

    def feed(megabytes: int) -> int:
        for _ in range(megabytes):
            parser.feed(source.bytes(1 << 20))
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    before = feed(3)
    assert feed(10) < before + (4 << 20)
