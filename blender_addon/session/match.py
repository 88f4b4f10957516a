# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the sensors match the motion database, in one word."""

from __future__ import annotations

GOOD_BELOW_MPS2, FAIR_BELOW_MPS2 = 2.5, 4.5
"""Limits of the misfit, the mean distance between retrieved and measured readings.

Of 143 HDM05 clips reconstructed from databases with the performer, without, or without such
movements, those below the first had a median error of 8 cm and one in 30 was worse than a constant
pose; those between 11 cm and 10 in 52; those above 17 cm and 42 in 61.
"""


def match_of(misfit_mps2: float, *, is_guess: bool = False) -> str:
    """Good, fair or poor; is_guess: the database has nothing like the take."""
    if is_guess or misfit_mps2 >= FAIR_BELOW_MPS2:
        return "poor"
    return "good" if misfit_mps2 < GOOD_BELOW_MPS2 else "fair"
