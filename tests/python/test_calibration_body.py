# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration of sensors on a whole body that stands, bends its elbows and squats.

The body is the standard skeleton; its simulated sensors are turned, scaled and moved along their
bones by what the calibration has to find.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from guided_body import RATE_HZ, SITES, guided, planted_turns, worn
from scipy.spatial.transform import Rotation
from sparse_mocap import Take, read_motion, simulated, to_standard
from sparse_mocap.calibration import Steps, calibrate

ELBOWS, SQUATS = (4.0, 12.0), (13.0, 21.0)
STEPS = Steps((0.0, 3.0), (("bend_elbows", ELBOWS), ("squat", SQUATS)))


@pytest.mark.parametrize("seed", range(4))
def test_sensors_on_a_whole_body_are_calibrated(performance: Path, seed: int) -> None:
    source = np.random.default_rng(seed)
    skeleton = to_standard(read_motion(performance)[0])[0].skeleton
    places = source.uniform(0.3, 0.9, len(SITES))
    ideal = simulated(guided(skeleton, ELBOWS, SQUATS, 22.0), SITES, RATE_HZ, list(places))
    turned = planted_turns(source)
    scales = source.uniform(0.95, 1.05, len(SITES))
    take = Take(
        {
            site: worn(ideal.sensors[site], turned[i], scales[i], 10 * seed + i)
            for i, site in enumerate(SITES)
        }
    )
    found = calibrate(take, STEPS, body=skeleton)
    for i, site in enumerate(SITES):
        sensor = found.sensors[site]
        error = (Rotation.from_matrix(sensor.R_site_sensor) * turned[i].inv()).magnitude()
        assert np.degrees(error) < 5.0, site
        assert sensor.scale == pytest.approx(scales[i], rel=0.01)
        if sensor.is_position_determined:
            assert sensor.position_along_bone == pytest.approx(places[i], abs=0.1), site
        else:
            assert any("place" in note for note in sensor.notes)
