# SPDX-License-Identifier: GPL-3.0-or-later
"""How well the sensors match the database, in one word."""

import pytest

from blender_addon.session.match import match_of


@pytest.mark.parametrize(
    ("misfit_mps2", "word"),
    [(0.0, "good"), (2.49, "good"), (2.5, "fair"), (4.49, "fair"), (4.5, "poor"), (50.0, "poor")],
)
def test_the_larger_the_misfit_the_worse_the_match(misfit_mps2: float, word: str) -> None:
    assert match_of(misfit_mps2) == word


def test_a_guess_is_a_poor_match() -> None:
    assert match_of(0.0, is_guess=True) == "poor"
