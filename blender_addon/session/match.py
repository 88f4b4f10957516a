# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the sensors match the motion database, in one word."""

from __future__ import annotations

GOOD_BELOW_MPS2, FAIR_BELOW_MPS2 = 2.0, 4.0
"""Limits of the mean distance between the retrieved readings and the measured ones."""


def match_of(misfit_mps2: float, *, is_guess: bool = False) -> str:
    """Good, fair or poor; is_guess: the database holds nothing like the take."""
    if is_guess or misfit_mps2 >= FAIR_BELOW_MPS2:
        return "poor"
    return "good" if misfit_mps2 < GOOD_BELOW_MPS2 else "fair"
