# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in steps: generators that yield the fraction done and return the result."""

from __future__ import annotations

import time
from collections.abc import Generator
from typing import Generic, TypeVar

T = TypeVar("T")

Steps = Generator[float, None, T]


def finished(steps: Steps[T]) -> T:
    """Do all steps now and return the result."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: T = end.value
            return result


def part(steps: Steps[T], begin: float, share: float) -> Steps[T]:
    """The same steps as a part (begin, share) of larger work."""
    try:
        while True:
            yield begin + share * next(steps)
    except StopIteration as end:
        result: T = end.value
        return result
    finally:
        steps.close()


class Slices(Generic[T]):
    """Does steps in slices of time."""

    def __init__(self, steps: Steps[T]) -> None:
        self.fraction = 0.0
        self.result: T | None = None
        self._steps = steps

    def advance(self, seconds: float) -> bool:
        """Work for this long; returns whether all steps are done. Raises what a step raises."""
        end = time.perf_counter() + seconds
        try:
            while True:
                self.fraction = next(self._steps)
                if time.perf_counter() >= end:
                    return False
        except StopIteration as done:
            self.result = done.value
            return True

    def close(self) -> None:
        """Stop early; the steps clean up."""
        self._steps.close()
