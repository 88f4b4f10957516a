# SPDX-License-Identifier: GPL-3.0-or-later
"""After a silence, live readings are true again and the take is as long as it was.

`./dev endure silence` does the same for longer and with every driver.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from silence_support import silence
from sparse_mocap.capture import Faults

CASES = {
    "stalled": ("xsens_mt", 6.0, Faults(stalls=((1.5, 0.1), (3.0, 1.5))), 1),
    "restarted": ("text_line", 4.0, Faults(resets_s=(2.0,)), 1),
    "played again": ("ximu3", 2.5, Faults(), 2),
}


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
@pytest.mark.parametrize("name", CASES)
def test_readings_are_true_again_and_the_gap_stays(name: str, tmp_path: Path) -> None:
    driver, seconds, faults, plays = CASES[name]
    found = silence(tmp_path, driver, seconds, faults, plays)
    # Twice what is allowed on an idle machine: others may run beside.
    assert found.back_s < 1.0
    assert found.length_error < 0.01
