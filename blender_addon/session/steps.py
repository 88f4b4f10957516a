# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in steps that yield the share that is done; what they return is the result."""

from __future__ import annotations

import time
from collections.abc import Generator
from typing import Generic, TypeVar

T = TypeVar("T")

Steps = Generator[float, None, T]


def finished(steps: Steps[T]) -> T:
    """The result of the steps, all done here and now."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            result: T = end.value
            return result


def part(steps: Steps[T], begin: float, share: float) -> Steps[T]:
    """The same steps as a share of larger work that begins at that share of it."""
    try:
        while True:
            yield begin + share * next(steps)
    except StopIteration as end:
        result: T = end.value
        return result
    finally:
        steps.close()


class Slices(Generic[T]):
    """Steps done a slice of time after another."""

    def __init__(self, steps: Steps[T]) -> None:
        self.fraction = 0.0
        self.result: T | None = None
        self._steps = steps

    def advance(self, seconds: float) -> bool:
        """Work for that long; whether all is done then. Raises what a step raises."""
        end = time.monotonic() + seconds
        try:
            while True:
                self.fraction = next(self._steps)
                if time.monotonic() >= end:
                    return False
        except StopIteration as done:
            self.result = done.value
            return True

    def close(self) -> None:
        """Leave the rest undone; the steps clean up."""
        self._steps.close()
