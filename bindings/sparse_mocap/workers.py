# SPDX-License-Identifier: GPL-3.0-or-later
"""Who does the work that can be divided: the processors of this machine, or a Dask cluster."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice
from typing import TypeVar

from ._core import ConfigError

__all__ = ["cluster", "in_order", "processors", "version_here"]

Asked = TypeVar("Asked")
Found = TypeVar("Found")

_RETRIES = 3
"""How often work is given to another worker when the one that had it was lost."""

_MOST_BEGUN = 1000
"""How many pieces of work are given out before the first of them is fetched."""
_PATIENCE_S = 0.2


@contextmanager
def processors(num_threads: int = 0) -> Iterator[Executor]:
    """Yields an executor for work that releases the GIL; 0: a thread for each processor.

    What has not begun when the block is left by an exception is never begun.
    """
    executor = ThreadPoolExecutor(num_threads or os.cpu_count() or 1)
    try:
        yield executor
    finally:
        executor.shutdown(cancel_futures=True)


@contextmanager
def cluster(address: str, timeout_s: float = 10.0) -> Iterator[Executor]:
    """Yields an executor for functions of this package, on the workers of a Dask scheduler.

    Paths are the workers' own: files must be on a disk that all of them share. Work of a worker
    that is lost goes to another one. Raises ConfigError where no scheduler answers, it has no
    workers, or one has another version of this package.
    """
    try:
        from dask.distributed import Client
    except ImportError:
        raise ConfigError(
            "a Dask scheduler needs dask.distributed; install it with: pip install"
            " 'sparse-mocap[cluster]'"
        ) from None
    try:
        client = Client(address, timeout=timeout_s)
    except (OSError, ValueError) as error:
        raise ConfigError(
            f"no Dask scheduler answers at {address}; is it started? ({error})"
        ) from error
    with client:
        _require_same_version(address, client.run(_version_there))
        executor = client.get_executor(pure=False, retries=_RETRIES)
        try:
            yield executor
        finally:
            executor.shutdown(wait=False)


def in_order(
    executor: Executor, work: Callable[[Asked], Found], pieces: Sequence[Asked]
) -> Iterator[Found | None]:
    """Yields work(piece) for each piece, in their order; None every now and then while waiting.

    What has not begun when the iterator is closed is never begun.
    """
    left = iter(pieces)
    begun: deque[Future[Found]] = deque()
    begun.extend(executor.submit(work, piece) for piece in islice(left, _MOST_BEGUN))
    try:
        while begun:
            wait([begun[0]], timeout=_PATIENCE_S)
            if not begun[0].done():
                yield None
                continue
            found = begun.popleft().result()
            begun.extend(executor.submit(work, piece) for piece in islice(left, 1))
            yield found
    finally:
        for future in begun:
            future.cancel()


def version_here() -> str:
    """Returns the version of this package."""
    from . import __version__

    return __version__


def _version_there() -> str:
    # Sent as it is, so that a worker without this package can answer.
    try:
        from sparse_mocap.workers import version_here as version
    except ImportError:
        return "no version"
    return version()


def _require_same_version(address: str, found: dict[str, str]) -> None:
    if not found:
        raise ConfigError(
            f"the Dask scheduler at {address} has no workers; start one: dask worker {address}"
        )
    for worker, version in found.items():
        if version != version_here():
            raise ConfigError(
                f"the worker {worker} has {version} of Sparse Mocap; {version_here()} is needed"
            )
