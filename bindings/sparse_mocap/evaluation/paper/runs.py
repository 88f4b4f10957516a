# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluations that are kept on disk, so that a run that was ended is taken up where it was."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from ... import Clip, MotionDatabase, Reconstruction
from ...files import write_text
from ..kept_database import fingerprint, kept_database
from ..performance import Performance
from ..protocol import Content, choose_tests, is_copy
from ..result import Evaluation
from ..runner import Settings, evaluate, reconstructions

__all__ = ["DATABASES", "Found", "Runs"]

Progress = Callable[[int, int, str], bool | None]
Found = dict[str, Any]
"""An evaluation's figures: "methods" by label, "tests" a list, "frames" of the database."""

DATABASES: dict[str, dict[str, Any]] = {
    "plain": {},
    "own proportions": {"own_proportions": True},
    "diverse": {"reverse": True, "tempo_copies": ()},
}
"""Options of build_database() by name; "diverse" has the further motion, too."""

_LEFT_OUT = ("movement", "classes", "jumps", "warnings", "part_errors_cm")
_FEW_TESTS = 6
_KEPT_VERSION = 1


class Runs:
    """Evaluations of one folder of motion, kept in another."""

    def __init__(
        self,
        source: Path,
        kept: Path,
        *,
        more: Path | None = None,
        every: int = 1,
        progress: Progress | None = None,
        executor: Executor | None = None,
    ) -> None:
        """more: further motion for the diverse database.

        every: tests each every-th clip alone, unless an evaluation of more clips is there.
        """
        self.source, self.more, self.kept, self.every = source, more, kept, every
        self._progress, self._executor = progress, executor
        self._databases: dict[str, MotionDatabase] = {}
        self._actors: tuple[str, ...] = ()
        self._files = fingerprint([source])
        self.part = (0, 1, "")
        """How many parts are done, of how many, and the one that is running."""
        self.num_clips: set[int] = set()
        """How many clips the evaluations of that part test."""
        (kept / "runs").mkdir(parents=True, exist_ok=True)

    def database(self, name: str = "plain") -> MotionDatabase:
        """Returns one of DATABASES, built when it is first asked for."""
        if name not in self._databases:
            sources = [self.source]
            if name == "diverse" and self.more is not None:
                sources.append(self.more)
            path = kept_database(sources, self.kept, progress=self._report, **DATABASES[name])
            self._databases[name] = MotionDatabase(path)
        return self._databases[name]

    @property
    def actors(self) -> tuple[str, ...]:
        """Who performs in the folder whose clips are tested, sorted."""
        if not self._actors:
            self._actors = tuple(sorted({clip.actor for clip in self.database().clips}))
        return self._actors

    def evaluation(self, settings: Settings, database: str = "plain") -> Found:
        """Returns an evaluation, from disk where it is there.

        Raises Cancelled; what was found until then is kept.
        """
        opened = self.database(database)
        samples = [self._sampled(settings, every) for every in range(1, self.every + 1)]
        paths = [self._path(opened, sample) for sample in samples]
        path = next((path for path in paths if path.exists()), paths[-1])
        settings = samples[-1]
        if not path.exists():
            found = evaluate(opened, self.source, settings, self._report, self._executor)
            write_text(path, json.dumps(_figures(found), allow_nan=False))
        told: Found = json.loads(path.read_text(encoding="utf-8"))
        self.num_clips.add(len(told["tests"]))
        return told

    def reconstructions(
        self, settings: Settings
    ) -> Iterator[tuple[Clip, Performance, dict[str, Reconstruction]]]:
        """Yields reconstructions with the plain database; these are not kept."""
        found = reconstructions(self.database(), self.source, settings)
        for number, (clip, performance, solved) in enumerate(found):
            self._report(number, 0, clip.name)
            yield clip, performance, solved

    def figures(
        self, what: str, settings: Settings, work: Callable[[Settings], Any], most: int
    ) -> Any:
        """Returns what work finds of reconstructions, from disk where it is there.

        ``what`` says what it looks for; it is a value of JSON. work(settings) gets about as many
        tests as ``most`` says.
        """
        path = self._path(self.database(), settings, f"{what} of {most} clips")
        if not path.exists():
            chosen = choose_tests(
                self.database().clips, settings.tests, settings.among, settings.per_class
            )
            every = max(1, len(chosen) // most)
            write_text(path, json.dumps(work(self._sampled(settings, every)), allow_nan=False))
        return json.loads(path.read_text(encoding="utf-8"))

    def can_test(self, among: Content) -> bool:
        """Returns whether any recorded clip is of this kind."""
        return bool(choose_tests(self.database().clips, among=among))

    def count(self, content: Content, database: str = "plain") -> int:
        """Returns how many frames such clips have in a database, without copies at other tempos."""
        clips = self.database(database).clips
        rest = content.rest(clips)
        return sum(
            clip.end - clip.begin
            for i, clip in enumerate(clips)
            if i not in rest and clip.tempo == 1.0
        )

    def recorded_seconds(self) -> float:
        """Returns how long the tested folder's motion is."""
        opened = self.database()
        frames = sum(clip.end - clip.begin for clip in opened.clips if not is_copy(clip))
        return frames / opened.rate_hz

    @staticmethod
    def _sampled(settings: Settings, every: int) -> Settings:
        return replace(settings, every=settings.every * every)

    def _path(self, database: MotionDatabase, settings: Settings, what: str = "") -> Path:
        """Returns the file of an evaluation, named by its data, its settings and this package."""
        about: Sequence[Any] = [
            _KEPT_VERSION,
            database.rows_hash,
            self._files,
            asdict(settings),
            *([what] if what else []),
        ]
        key = hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:16]
        return self.kept / "runs" / f"{key}.json"

    def _report(self, done: int, total: int, what: str) -> bool | None:
        if self._progress is None:
            return None
        part, parts, title = self.part
        of_part = f" {done}/{total}" if total else ""
        return self._progress(part, parts, f"{title}{of_part} {what}")


def _figures(found: Evaluation) -> Found:
    told = found.as_dict()
    for method in told["methods"].values():
        for name in _LEFT_OUT:
            del method[name]
    kept = ("name", "actor", "motion_class", "frames", "excluded_clips")
    tests = [
        {name: test[name] for name in (*kept, "error_cm", "root_frame_cm")}
        for test in told["tests"]
    ]
    if len(tests) <= _FEW_TESTS:
        for test, own in zip(found.tests, tests, strict=True):
            own["root_frame_by_frame_cm"] = {
                label: [round(float(error), 2) for error in result.root_frame_errors_cm]
                for label, result in test.results.items()
                if result.root_frame_errors_cm is not None
            }
    return {
        "frames": told["settings"]["frames"],
        "rate_hz": told["settings"]["rate_hz"],
        "methods": told["methods"],
        "tests": tests,
        "left_out": told["left_out"],
    }
