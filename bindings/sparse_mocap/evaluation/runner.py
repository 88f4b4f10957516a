# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import (
    Cancelled,
    Clip,
    FormatError,
    MappingError,
    MotionDatabase,
    Reconstruction,
    nearest_poses,
    nearest_windows,
    playback_best_path,
    to_standard,
)
from ..databases import content_hash, shared_database
from ..readings import SensorInput, all_readings
from ..reconstruction import reconstruct
from ..report import match
from ..table_errors import TableError
from .comparison import Estimate, Truth, world_of
from .contender import Contender, contenders
from .models import Trainer
from .performance import PAPER_SITES, Performance, heading_rotations, performed
from .protocol import choose_tests, excluded_clips, motion_files, source_path
from .result import Evaluation, TestClip

__all__ = ["Settings", "evaluate", "tested_clip"]

Floats = NDArray[np.float64]
Progress = Callable[[int, int, str], bool | None]

WINDOW = 10
BASELINES = {
    "oracle": "the database's nearest pose to the truth",
    "playback": "the frame at the end of the best path",
    f"window of {WINDOW}": f"the frame whose last {WINDOW} readings are nearest",
    "mean pose": "the clip's own mean, held still",
}


@dataclass(frozen=True)
class Settings:
    """What an evaluation varies."""

    scenario: int = 1
    contenders: tuple[Contender, ...] = ()
    """Empty: every method that needs a database alone, live."""
    tests: str | None = None
    """A pattern on file names; None is one clip for each actor and class."""
    every: int = 1
    """Of the clips that would be tested, only every so many-th is."""
    pairs: tuple[tuple[str, str], ...] = ()
    """Patterns on the names of training and test clips, in place of a scenario's split."""
    sites: tuple[str, ...] = PAPER_SITES
    noise: str = "none"
    seed: int = 0
    channels: tuple[str, ...] = ("specific_force",)
    """What the sensors give."""
    with_gyroscopes: bool = False
    """Whether they have gyroscopes beside that."""

    @property
    def all_channels(self) -> tuple[str, ...]:
        """What the sensors give, gyroscopes included."""
        return (*self.channels, *(["angular_velocity"] * self.with_gyroscopes))

    @property
    def all_sites(self) -> tuple[str, ...]:
        """Where the contenders have sensors."""
        own = [site for contender in self.contenders for site in contender.sensors]
        return tuple(dict.fromkeys((*self.sites, *own)))


def evaluate(
    database: MotionDatabase,
    source: Path,
    settings: Settings = Settings(),
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> Evaluation:
    """Returns how well performances of the database's own files are reconstructed.

    What comes from the performed file is hidden from the database, and what the scenario says.
    ``source`` is the folder that the database was built from. ``progress`` cancels the evaluation
    by returning False, which raises Cancelled. ``executor`` (see workers) tests the clips; both
    paths must mean the same there.
    """
    return _Run(database, source, settings, progress).run(executor)


def tested_clip(
    database: str, database_hash: str, source: str, settings: Settings, test: int, hidden: list[int]
) -> tuple[TestClip | None, dict[str, float | None], str]:
    """Returns how the test of one clip went and each method's latency (ms), or why it did not."""
    run = _Run(shared_database(database, database_hash), Path(source), settings, None)
    return run.tested(test, hidden)


class _Run:
    def __init__(
        self,
        database: MotionDatabase,
        source: Path,
        settings: Settings,
        progress: Progress | None,
    ) -> None:
        self.database, self.settings, self.progress = database, settings, progress
        self.source = source
        self.contenders = settings.contenders or tuple(contenders(("path_regression",)))
        self.clips: list[Clip] = database.clips
        self.files = motion_files(source)
        self.trainer = Trainer(self.clips, self.files)
        self.truths = database.array("positions").reshape(database.num_frames, -1, 3)
        self.evaluation = Evaluation(
            settings.scenario,
            asdict(settings)
            | {"source": str(source), "rate_hz": database.rate_hz, "frames": database.num_frames},
            list(database.skeleton.names),
            {},
        )

    def run(self, executor: Executor | None) -> Evaluation:
        tests = self._tests()
        if not tests:
            raise self._nothing_to_test(f"no clip matches {self.settings.tests!r}")
        for test, latencies_ms, problem in self._each_tested(tests, executor):
            if test is None:
                self.evaluation.left_out.append(problem)
                continue
            self.evaluation.tests.append(test)
            self.evaluation.latencies_ms |= latencies_ms
        self._report(len(tests), len(tests), "")
        if not self.evaluation.tests:
            raise self._nothing_to_test(self.evaluation.left_out[0])
        return self.evaluation

    def _each_tested(
        self, tests: list[tuple[int, list[int]]], executor: Executor | None
    ) -> Iterator[tuple[TestClip | None, dict[str, float | None], str]]:
        if executor is None:
            for done, (test, excluded) in enumerate(tests):
                self._report(done, len(tests), self.clips[test].name)
                yield self.tested(test, excluded)
            return
        path = self.database.path
        about = (path, content_hash(path), str(self.source.absolute()))
        pending = [executor.submit(tested_clip, *about, self.settings, *test) for test in tests]
        try:
            for done, future in enumerate(pending):
                self._report(done, len(tests), self.clips[tests[done][0]].name)
                yield future.result()
        finally:
            for future in pending:
                future.cancel()

    def tested(
        self, test: int, excluded: list[int]
    ) -> tuple[TestClip | None, dict[str, float | None], str]:
        """Returns the test of one clip and each method's latency (ms), or why there is none."""
        self.latencies_ms: dict[str, float | None] = {}
        try:
            return self._test(test, excluded), self.latencies_ms, ""
        except (FormatError, MappingError) as error:
            return None, {}, f"{self.clips[test].name}: {error}"

    def _tests(self) -> list[tuple[int, list[int]]]:
        """Returns the clips to test, and for each those that the database must not have then."""
        settings = self.settings
        if not settings.pairs:
            return [
                (test, excluded_clips(self.clips, test, settings.scenario))
                for test in choose_tests(self.clips, settings.tests)[:: settings.every]
            ]
        found = []
        for training, pattern in settings.pairs:
            known = set(choose_tests(self.clips, training))
            for test in choose_tests(self.clips, pattern):
                hidden = set(excluded_clips(self.clips, test, 1))
                others = set(range(len(self.clips))) - known
                found.append((test, sorted(hidden | others)))
        return found

    def _nothing_to_test(self, reason: str) -> FormatError:
        return TableError(self.database.path, 0, f"nothing can be tested: {reason}")

    def _report(self, done: int, total: int, what: str) -> None:
        if self.progress is not None and self.progress(done, total, what) is False:
            raise Cancelled("cancelled")

    def _test(self, index: int, excluded: list[int]) -> TestClip:
        clip = self.clips[index]
        if len(excluded) == len(self.clips):
            raise TableError(clip.source, 0, "is all that the scenario's database would hold")
        performance = performed(
            source_path(self.files, clip),
            sites=self.settings.all_sites,
            noise=self.settings.noise,
            seed=self.settings.seed,
        )
        truth = Truth(self.database, clip, performance.motion_on(self.database))
        test = TestClip(
            clip.name,
            clip.actor,
            clip.motion_class,
            len(truth.positions),
            len(excluded),
            truth.jerk_kmps3,
            truth.movement(),
        )
        hidden = self._hidden_from_all(index, excluded)
        estimates = [
            self._estimate(one, performance, hidden if one.knows_all_clips else excluded)
            for one in self.contenders
        ]
        for estimate in estimates + self._baselines(performance, truth.positions, excluded):
            test.results[estimate.label] = truth.compared(estimate)
        return test

    def _hidden_from_all(self, test: int, excluded: Sequence[int]) -> list[int]:
        """Returns what is hidden from a contender that knows all clips but the tests.

        The performer's other clips, too, where the training clips are of others.
        """
        hidden, actor = set(excluded), self.clips[test].actor
        is_known = any(
            clip.actor == actor for index, clip in enumerate(self.clips) if index not in hidden
        )
        return excluded_clips(self.clips, test, 1 if is_known else 3)

    def _estimate(
        self, contender: Contender, performance: Performance, excluded: Sequence[int]
    ) -> Estimate:
        solved = self._solved(contender, performance, excluded)
        late = solved.latency_s
        self.latencies_ms[contender.label] = None if late is None else 1000.0 * late
        motion, _ = to_standard(solved.motion.without_extremities(), self.database.skeleton)
        return Estimate(
            contender.label,
            np.asarray(solved.readings.times_s),
            np.asarray(motion.joint_positions("heading")),
            heading_rotations(motion),
            world_of(motion),
            match=match(solved, self.database)
            if "sensor_misfit_mps2" in solved.diagnostics
            else None,
        )

    def _solved(
        self, contender: Contender, performance: Performance, excluded: Sequence[int]
    ) -> Reconstruction:
        needs = contender.info.needs
        common = dict.fromkeys(self.settings.sites, self.settings.all_channels)
        return reconstruct(
            performance.seen(contender.sensors or common),
            self.database if "database" in needs else None,
            method=contender.method,
            preset=contender.preset,
            options=contender.options,
            best_quality=contender.best_quality,
            model=self.trainer.model(contender, excluded) if "model" in needs else None,
            body=performance.motion.skeleton,
            excluded_clips=excluded if "database" in needs else (),
        )

    def _baselines(
        self, performance: Performance, truth: Floats, excluded: Sequence[int]
    ) -> list[Estimate]:
        database = self.database
        sites = self.settings.sites
        take = performance.seen(dict.fromkeys(sites, ("specific_force",)))
        inputs = [SensorInput(site, ["specific_force"]) for site in sites]
        readings = all_readings(take, inputs, database.rate_hz)
        truth_times = np.arange(len(truth)) / database.rate_hz
        frames = (
            (truth_times, nearest_poses(database, truth, excluded)),
            (readings.times_s, playback_best_path(database, readings, excluded)),
            (readings.times_s, nearest_windows(database, readings, WINDOW, excluded)),
        )
        angles = database.array("angles")
        found = [
            Estimate(
                name,
                times,
                np.asarray(self.truths[rows], float),
                angles_rad=np.asarray(angles[rows], float),
            )
            for name, (times, rows) in zip(BASELINES, frames, strict=False)
        ]
        mean_pose = np.broadcast_to(truth.mean(axis=0), truth.shape)
        found.append(Estimate("mean pose", truth_times, mean_pose))
        self.latencies_ms |= dict.fromkeys(BASELINES)
        return found
