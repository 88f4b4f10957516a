# SPDX-License-Identifier: GPL-3.0-or-later
"""Where motion capture for a database can be downloaded for free, and on which terms."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FreeMotions:
    """A collection of motion capture."""

    name: str
    terms: str
    url: str


FREE_MOTIONS = (
    FreeMotions(
        "CMU",
        "Free for any use but selling the data; name mocap.cs.cmu.edu and NSF EIA-0196217",
        "http://mocap.cs.cmu.edu",
    ),
    FreeMotions(
        "HDM05",
        "CC BY-SA 3.0; cite Müller et al., Mocap Database HDM05",
        "https://resources.mpi-inf.mpg.de/HDM05/",
    ),
    FreeMotions(
        "Bandai Namco",
        "CC BY-NC 4.0: not for commercial work",
        "https://github.com/BandaiNamcoResearchInc/Bandai-Namco-Research-Motiondataset",
    ),
)
