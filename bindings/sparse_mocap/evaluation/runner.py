# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests of a scenario."""

from __future__ import annotations

from bisect import bisect_right
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
from .clip_result import TestClip
from .comparison import Estimate, Truth, world_of
from .contender import Contender, contenders
from .models import Trainer
from .performance import (
    PAPER_SITES,
    SENSOR_RATE_HZ,
    Performance,
    heading_rotations,
    performed,
)
from .protocol import EVERYTHING, Content, choose_tests, excluded_clips, motion_files, source_path
from .result import Evaluation
from .same_motion import same_motion

__all__ = ["Settings", "evaluate", "reconstructions", "tested_clip"]

Floats = NDArray[np.float64]
Progress = Callable[[int, int, str], bool | None]

WINDOW = 10
WORK = ("components", "iterations")
"""What methods may say of their own work, see ClipResult."""
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
    among: Content = EVERYTHING
    """Which clips may be tested."""
    per_class: int = 1
    """How many clips of each actor and class are tested, without a pattern."""
    known: Content = EVERYTHING
    """Which clips the database has, before the scenario hides some."""
    body_scale: float = 1.0
    """The performers' size beside the recorded one."""
    tempos: tuple[float, ...] = (1.0,)
    """How fast the clips are performed, from beginning to end, linear between."""
    with_baselines: bool = True
    """Whether what every method is compared with is looked at as well."""
    pairs: tuple[tuple[str, str], ...] = ()
    """Patterns on the names of training and test clips, in place of a scenario's split."""
    sites: tuple[str, ...] = PAPER_SITES
    noise: str = "none"
    seed: int = 0
    sensor_rate_hz: float = SENSOR_RATE_HZ
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


def reconstructions(
    database: MotionDatabase, source: Path, settings: Settings
) -> Iterator[tuple[Clip, Performance, dict[str, Reconstruction]]]:
    """Yields each test's clip, its performance, and what each contender makes of that, by label."""
    return _Run(database, source, settings, None).reconstructions()


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
        self.clip_begins = [clip.begin for clip in self.clips]
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
            chosen = choose_tests(self.clips, settings.tests, settings.among, settings.per_class)
            others = settings.known.rest(self.clips)
            return [
                (test, sorted(others.union(self._excluded(test, settings.scenario))))
                for test in chosen[:: settings.every]
            ]
        found = []
        for training, pattern in settings.pairs:
            known = set(choose_tests(self.clips, training))
            for test in choose_tests(self.clips, pattern):
                hidden = set(self._excluded(test, 1))
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
        performance = self._performed(clip)
        motion = performance.motion_on(self.database)
        clip_times_s = performance.clip_times_s(motion.num_frames, self.database.rate_hz)
        truth = Truth(self.database, clip, motion, clip_times_s)
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
        if self.settings.with_baselines:
            estimates += self._baselines(performance, truth, excluded)
        for estimate in estimates:
            test.results[estimate.label] = truth.compared(estimate)
        return test

    def reconstructions(self) -> Iterator[tuple[Clip, Performance, dict[str, Reconstruction]]]:
        for index, excluded in self._tests():
            clip = self.clips[index]
            performance = self._performed(clip)
            yield (
                clip,
                performance,
                {one.label: self._solved(one, performance, excluded) for one in self.contenders},
            )

    def _performed(self, clip: Clip) -> Performance:
        settings = self.settings
        return performed(
            source_path(self.files, clip),
            sites=settings.all_sites,
            noise=settings.noise,
            seed=settings.seed,
            rate_hz=settings.sensor_rate_hz,
            body_scale=settings.body_scale,
            tempos=settings.tempos,
        )

    def _hidden_from_all(self, test: int, excluded: Sequence[int]) -> list[int]:
        """Returns what is hidden from a contender that knows all clips but the tests.

        The performer's other clips, too, where the training clips are of others.
        """
        hidden, actor = set(excluded), self.clips[test].actor
        is_known = any(
            clip.actor == actor for index, clip in enumerate(self.clips) if index not in hidden
        )
        return self._excluded(test, 1 if is_known else 3)

    def _excluded(self, test: int, scenario: int) -> list[int]:
        """Returns the clips that a scenario hides, and all that show the test's movement."""
        clip = self.clips[test]
        same = same_motion(self.database).sources_with(clip.begin, clip.end)
        return excluded_clips(self.clips, test, scenario, same)

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
            np.asarray(motion.joint_positions("root")),
            heading_rotations(motion),
            world_of(motion),
            match=match(solved, self.database)
            if "sensor_misfit_mps2" in solved.diagnostics
            else None,
            work={
                name: float(np.mean(solved.diagnostics[name]))
                for name in WORK
                if name in solved.diagnostics
            },
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
        self, performance: Performance, truth: Truth, excluded: Sequence[int]
    ) -> list[Estimate]:
        database, poses = self.database, truth.positions
        sites = self.settings.sites
        take = performance.seen(dict.fromkeys(sites, ("specific_force",)))
        inputs = [SensorInput(site, ["specific_force"]) for site in sites]
        readings = all_readings(take, inputs, database.rate_hz)
        frames = (
            (truth.times_s, nearest_poses(database, poses, excluded)),
            (readings.times_s, playback_best_path(database, readings, excluded)),
            (readings.times_s, nearest_windows(database, readings, WINDOW, excluded)),
        )
        angles = database.array("angles")
        found = [
            Estimate(
                name,
                times,
                np.asarray(self.truths[rows], float),
                self._in_root_frame(rows),
                angles_rad=np.asarray(angles[rows], float),
            )
            for name, (times, rows) in zip(BASELINES, frames, strict=False)
        ]
        in_heading, in_root = (
            np.broadcast_to(true.mean(axis=0), true.shape) for true in (poses, truth.root_positions)
        )
        found.append(Estimate("mean pose", truth.times_s, in_heading, in_root))
        self.latencies_ms |= dict.fromkeys(BASELINES)
        return found

    def _in_root_frame(self, rows: NDArray[np.int64]) -> Floats:
        """Returns the positions (T, J, 3) of the database's frames in the root frame."""
        clips = {bisect_right(self.clip_begins, row) - 1 for row in rows}
        found = np.zeros((len(rows), self.truths.shape[1], 3))
        for index in clips:
            clip = self.clips[index]
            is_there = (rows >= clip.begin) & (rows < clip.end)
            positions = self.database.clip_motion(index).joint_positions("root")
            found[is_there] = np.asarray(positions)[rows[is_there] - clip.begin]
        return found
