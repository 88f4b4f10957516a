# SPDX-License-Identifier: GPL-3.0-or-later
"""Many takes with the same settings: each becomes a motion file, and none is solved twice."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ._core import Cancelled, ConfigError, FormatError, MotionDatabase, read_model, write_bvh
from .body_file import read_body
from .calibration_file import read_calibration
from .databases import shared_database
from .files import write_text
from .methods import DEFAULT_METHOD, method_info
from .reconstruction import reconstruct
from .report import match
from .take import read_take
from .workers import version_here

__all__ = [
    "BatchSettings",
    "Solved",
    "outputs",
    "solve_batch",
    "solve_take",
]

_FORMAT = "sparse_mocap_batch"
_FORMAT_VERSION = 1


@dataclass(frozen=True)
class BatchSettings:
    """What all takes of a batch are solved with.

    Paths are absolute, and mean the same files wherever the work is done.
    """

    database: str | None
    database_hash: str | None = None
    """Of the database's content (content_hash): another file at that path is refused."""
    method: str | None = None
    preset: str | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    best_quality: bool = False
    use_gyroscopes: bool = True
    calibration: str | None = None
    model: str | None = None
    body: str | None = None


@dataclass(frozen=True)
class Solved:
    """What became of one take."""

    take: str
    output: str
    num_frames: int = 0
    match: str = ""
    """good, fair or poor."""
    was_there: bool = False
    """Whether an earlier batch had solved it."""
    error: str | None = None
    """One line; the output is untouched then."""


def outputs(takes: Sequence[Path], folder: Path) -> dict[Path, Path]:
    """Returns the motion file of each take; a folder stands for the takes in it, recursively.

    Raises ConfigError for a take that is not there, a folder without takes, and two takes that
    would become one file.
    """
    found: dict[Path, Path] = {}
    for given in takes:
        if not given.exists():
            raise ConfigError(f"{given}: no such file or folder")
        inside = sorted(path for path in given.rglob("*.csv") if path.is_file())
        if given.is_dir() and not inside:
            raise ConfigError(f"{given}: there are no takes (.csv) in this folder")
        for take in inside if given.is_dir() else [given]:
            relative = take.relative_to(given) if given.is_dir() else Path(take.name)
            found[take.absolute()] = (folder / relative).absolute().with_suffix(".bvh")
    names: dict[Path, Path] = {}
    for take, output in found.items():
        if names.setdefault(output, take) != take:
            raise ConfigError(f"{take} and {names[output]} would both become {output}: rename one")
    return found


def solve_batch(
    takes: Mapping[Path, Path],
    settings: BatchSettings,
    executor: Executor,
    done: Callable[[Solved, int], bool | None] = lambda solved, count: True,
) -> list[Solved]:
    """Returns what became of each take, in their order.

    takes: the motion file of each, as outputs() gives them. executor: see workers. done(solved,
    count of those that are done) is called for each as it comes, and cancels by returning False,
    which raises Cancelled; what is solved by then stays. Errors of a take are its own.
    """
    solved: dict[str, Solved] = {}
    pending = [
        executor.submit(solve_take, str(take), str(to), settings) for take, to in takes.items()
    ]
    try:
        for future in as_completed(pending):
            one = future.result()
            solved[one.take] = one
            if done(one, len(solved)) is False:
                raise Cancelled("cancelled")
    except BaseException:
        for future in pending:
            future.cancel()
        raise
    return [solved[str(take)] for take in takes]


def solve_take(take: str, output: str, settings: BatchSettings) -> Solved:
    """Solves a take and writes its motion (.bvh), unless an earlier batch did just that.

    Beside it stands what it was made from (.batch.json), written last.
    """
    try:
        return _solve_take(Path(take), Path(output), settings)
    except (FormatError, ConfigError, OSError) as error:
        return Solved(take, output, error=" ".join(str(error).split()))


def _solve_take(take: Path, output: Path, settings: BatchSettings) -> Solved:
    made_from = _made_from(take, settings)
    note = output.with_suffix(".batch.json")
    earlier = _read_note(note)
    if output.exists() and earlier.get("made_from") == made_from:
        return Solved(
            str(take), str(output), earlier["num_frames"], earlier["match"], was_there=True
        )
    database = None
    if settings.database is not None:
        database = shared_database(settings.database, settings.database_hash)
    info = method_info(settings.method or DEFAULT_METHOD)
    result = reconstruct(
        read_take(take),
        database,
        best_quality=settings.best_quality,
        method=settings.method,
        preset=settings.preset,
        options=settings.options,
        calibration=read_calibration(Path(settings.calibration)) if settings.calibration else None,
        use_gyroscopes=settings.use_gyroscopes,
        model=_model(settings, info.name, info.needs, database),
        body=read_body(Path(settings.body)).skeleton if settings.body else None,
    )
    output.parent.mkdir(parents=True, exist_ok=True)
    write_bvh(output, result.motion)
    solved = Solved(str(take), str(output), result.motion.num_frames, match(result, database))
    about = {"format": _FORMAT, "format_version": _FORMAT_VERSION, "made_from": made_from}
    figures = {"num_frames": solved.num_frames, "match": solved.match}
    write_text(note, json.dumps(about | figures, indent=2) + "\n")
    return solved


def _made_from(take: Path, settings: BatchSettings) -> dict[str, Any]:
    """Returns all that the motion depends on; files by their content."""
    about = asdict(settings)
    for name in ("calibration", "model", "body"):
        if about[name] is not None:
            about[name] = _file_hash(about[name])
    del about["database"]
    return {"take": _file_hash(take), "version": version_here()} | about


def _file_hash(path: str | os.PathLike[str]) -> str:
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _read_note(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    is_ours = isinstance(found, dict) and found.get("format_version") == _FORMAT_VERSION
    return found if is_ours else {}


def _model(
    settings: BatchSettings, method: str, needs: Sequence[str], database: MotionDatabase | None
) -> Any:
    if settings.model is not None:
        return read_model(settings.model)
    return database.model(method) if "model" in needs and database is not None else None
