# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion databases: built from motion files, and files added to one.

Both find the files' labels (see labels), leave the rest to the core, and learn then what good and
poor reconstructions look like (see quality_calibration).
"""

from __future__ import annotations

import functools
import hashlib
import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING

from . import _core
from .labels import find_labels
from .motion_files import read_options
from .quality_calibration import calibrate_quality
from .workers import in_order

if TYPE_CHECKING:
    from typing import Unpack

    from ._core_database import _ImportOptions

__all__ = ["add_to_database", "build_database", "content_hash", "shared_database"]

Path = str | os.PathLike[str]


def build_database(
    sources: Sequence[Path],
    output: Path,
    *,
    rate_hz: float = 25.0,
    mirror: bool = False,
    reverse: bool = False,
    tempo_copies: Sequence[float] = (0.8, 1.25),
    own_proportions: bool = False,
    exclude: Sequence[str] = (),
    metadata: Path | None = None,
    workers: Executor | None = None,
    **options: Unpack[_ImportOptions],
) -> _core.BuildReport:
    """Builds a database from motion files and folders of them, and tells what came of it.

    rate_hz: frames a second; mirror, reverse: whether clips are added mirrored and backwards too;
    tempo_copies: tempos at which a small database holds each clip once more; own_proportions:
    readings are of each body's own, not the averaged ones; exclude: patterns of file names;
    metadata: a table file,actor,class,source,license (None: the folders' metadata.csv); workers:
    who reads the files (see workers.cluster), at the same paths; the database is the same.

    Further options: strict stops at the first file that cannot be used or is doubtful (check_clip
    in the core has the limits); read: see read_options; keep_duplicates also takes files whose
    motion is there; num_threads (0: one a processor; the file is the same); by_hand: joints for
    skeletons that have them all; mappings: a folder of mappings by hand for others;
    progress(done, total, what) may return False to cancel; details gets each ProgressReport before.

    Raises FormatError (nothing usable, or strict), ConfigError, Cancelled and OSError; output is
    untouched then.
    """
    sources = _found_by(workers, sources)
    labels, warnings = find_labels(sources, exclude, metadata)
    options.setdefault("read", read_options())
    report = _core.build_database(
        sources,
        output,
        rate_hz=rate_hz,
        mirror=mirror,
        reverse=reverse,
        tempo_copies=tempo_copies,
        own_proportions=own_proportions,
        exclude=exclude,
        labels=labels,
        label_warnings=warnings,
        remote=None if workers is None else _remote_work(workers),
        **options,
    )
    calibrate_quality(output)
    return report


def add_to_database(
    database: Path,
    sources: Sequence[Path],
    output: Path | None = None,
    *,
    exclude: Sequence[str] = (),
    metadata: Path | None = None,
    rebuild: bool = False,
    takes: Mapping[Path, _core.PairedTake] | None = None,
    workers: Executor | None = None,
    **options: Unpack[_ImportOptions],
) -> _core.BuildReport:
    """Adds motion files on the database's skeleton, at its rate, with its kinds of copies.

    Replaces the database (atomically) when output is None. Files that are in are not read again.
    Programs that add to one database at once wait for one another. A warning says how far new
    actors would change the averaged skeleton; rebuild averages it anew and needs the database's
    own files among the sources too. takes: what sensors recorded while files were performed, by the
    files' paths (see teaching.pair_take); such a file replaces what it gave before. Options and
    errors as for build_database.
    """
    sources = _found_by(workers, sources)
    takes = {_found_by(workers, [path])[0]: take for path, take in (takes or {}).items()}
    labels, warnings = find_labels(sources, exclude, metadata)
    options.setdefault("read", read_options())
    report = _core.add_to_database(
        database,
        sources,
        output,
        exclude=exclude,
        labels=labels,
        label_warnings=warnings,
        rebuild=rebuild,
        takes=takes,
        remote=None if workers is None else _remote_work(workers),
        **options,
    )
    calibrate_quality(database if output is None else output)
    return report


def _found_by(workers: Executor | None, sources: Sequence[Path]) -> Sequence[Path]:
    """Returns the sources as other processes find them, too."""
    return sources if workers is None else [os.path.abspath(source) for source in sources]


def _remote_work(workers: Executor) -> Callable[[list[bytes]], Iterator[bytes | None]]:
    def answers(requests: list[bytes]) -> Iterator[bytes | None]:
        pieces = [requests[i : i + _FILES_AT_ONCE] for i in range(0, len(requests), _FILES_AT_ONCE)]
        for found in in_order(workers, _answers, pieces):
            if found is None:
                yield None
            else:
                yield from found

    return answers


def _answers(requests: list[bytes]) -> list[bytes]:
    read = read_options()
    return [_core.answer_request(request, read) for request in requests]


def content_hash(database: Path) -> str:
    """Returns what tells a database's content from any other: the hash of the file's header.

    The header holds the checksums of all arrays, which opening the database compares.
    """
    with open(database, "rb") as file:
        size = int.from_bytes(file.read(8), "little")
        header = file.read(min(size, _MOST_HEADER_BYTES))
    return hashlib.sha256(header).hexdigest()


def shared_database(path: str, expected_hash: str | None = None) -> _core.MotionDatabase:
    """Returns the database, opened once in each process.

    Raises ConfigError if its content is another one than the hash says.
    """
    with _opening:
        return _opened(path, expected_hash)


_MOST_HEADER_BYTES = 1 << 30
_FILES_AT_ONCE = 8  # that a worker reads for one message
_opening = threading.Lock()


@functools.lru_cache(maxsize=1)
def _opened(path: str, expected_hash: str | None) -> _core.MotionDatabase:
    if expected_hash is not None and content_hash(path) != expected_hash:
        raise _core.ConfigError(f"{path}: has changed since the work began; start the work again")
    return _core.MotionDatabase(path)
