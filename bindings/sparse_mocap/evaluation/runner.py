# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
    readings_of,
)
from ..reconstruction import latency_ms
from ..table_errors import TableError
from .metrics import frame_errors, interpolated, joint_errors, mean_jerk
from .performance import PAPER_SITES, Performance, performed, reconstructed_positions
from .protocol import choose_tests, excluded_clips, motion_files, source_path
from .result import ClipResult, Evaluation, TestClip, clip_result

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
    method: str = "tautges2011"
    presets: tuple[str, ...] = ("default", "paper")
    with_offline: bool = False
    """Runs every preset a second time, looking at the whole performance."""
    tests: str | None = None
    """A pattern on file names; None is one clip for each actor and class."""
    sites: tuple[str, ...] = PAPER_SITES
    noise: str = "none"
    seed: int = 0
    with_gyroscopes: bool = False
    """Whether the sensors are inertial ones, not accelerometers alone."""


def evaluate(
    database: MotionDatabase,
    source: Path,
    settings: Settings = Settings(),
    progress: Progress | None = None,
) -> Evaluation:
    """Returns how well performances of the database's own files are reconstructed.

    What comes from the performed file is hidden from the database, and what the scenario says.
    ``source`` is the folder that the database was built from. ``progress`` cancels the evaluation
    by returning False, which raises Cancelled.
    """
    return _Run(database, source, settings, progress).run()


class _Run:
    def __init__(
        self,
        database: MotionDatabase,
        source: Path,
        settings: Settings,
        progress: Progress | None,
    ) -> None:
        self.database, self.settings, self.progress = database, settings, progress
        self.clips: list[Clip] = database.clips
        self.files = motion_files(source)
        self.truths = database.array("positions").reshape(database.num_frames, -1, 3)
        self.evaluation = Evaluation(
            settings.scenario,
            asdict(settings)
            | {"source": str(source), "rate_hz": database.rate_hz, "frames": database.num_frames},
            list(database.skeleton.names),
            {},
        )

    def run(self) -> Evaluation:
        tests = choose_tests(self.clips, self.settings.tests)
        if not tests:
            raise self._nothing_to_test(f"no clip matches {self.settings.tests!r}")
        for done, test in enumerate(tests):
            self._report(done, len(tests), self.clips[test].name)
            try:
                self._test(test)
            except (FormatError, MappingError) as error:
                self.evaluation.left_out.append(f"{self.clips[test].name}: {error}")
        self._report(len(tests), len(tests), "")
        if not self.evaluation.tests:
            raise self._nothing_to_test(self.evaluation.left_out[0])
        return self.evaluation

    def _nothing_to_test(self, reason: str) -> FormatError:
        return TableError(self.database.path, 0, f"nothing can be tested: {reason}")

    def _report(self, done: int, total: int, what: str) -> None:
        if self.progress is not None and self.progress(done, total, what) is False:
            raise Cancelled("cancelled")

    def _test(self, index: int) -> None:
        clip = self.clips[index]
        excluded = excluded_clips(self.clips, index, self.settings.scenario)
        if len(excluded) == len(self.clips):
            raise TableError(clip.source, 0, "is all that the scenario's database would hold")
        performance = performed(
            source_path(self.files, clip),
            self.database.rate_hz,
            sites=self.settings.sites,
            noise=self.settings.noise,
            seed=self.settings.seed,
        )
        truth = np.asarray(self.truths[clip.begin : clip.end], float)
        test = TestClip(
            clip.name,
            clip.actor,
            clip.motion_class,
            len(truth),
            len(excluded),
            mean_jerk(truth, self.database.rate_hz),
        )
        for method, times, positions in self._estimates(performance, truth, excluded):
            test.results[method] = self._compared(truth, times, positions)
        self.evaluation.tests.append(test)

    def _estimates(
        self, performance: Performance, truth: Floats, excluded: Sequence[int]
    ) -> list[tuple[str, Floats, Floats]]:
        """Returns name, times and positions (heading frame) of every method and baseline."""
        found = []
        for preset in self.settings.presets:
            for is_offline in (False, True) if self.settings.with_offline else (False,):
                name = f"{preset}, offline" if is_offline else preset
                solved = self._solved(name, preset, is_offline, performance, excluded)
                found.append((name, performance.times_s, reconstructed_positions(solved)))
        return found + self._baselines(performance, truth, excluded)

    def _solved(
        self,
        name: str,
        preset: str,
        is_offline: bool,
        performance: Performance,
        excluded: Sequence[int],
    ) -> Reconstruction:
        readings = readings_of(
            performance.take,
            self.database.rate_hz,
            offline=is_offline,
            uses_gyroscopes=self.settings.with_gyroscopes,
        )
        reconstructor = readings.channels.reconstructor(
            self.database, method=self.settings.method, preset=preset, excluded_clips=excluded
        )
        late = None if is_offline else latency_ms(reconstructor, self.database)
        self.evaluation.latencies_ms[name] = late
        return reconstructor.solve(readings.values, offline=is_offline)

    def _baselines(
        self, performance: Performance, truth: Floats, excluded: Sequence[int]
    ) -> list[tuple[str, Floats, Floats]]:
        database, sites, readings = self.database, self.settings.sites, performance.readings
        truth_times = np.arange(len(truth)) / database.rate_hz
        frames = (
            (truth_times, nearest_poses(database, truth, excluded)),
            (performance.times_s, playback_best_path(database, sites, readings, excluded)),
            (performance.times_s, nearest_windows(database, sites, readings, WINDOW, excluded)),
        )
        found = [
            (name, times, np.asarray(self.truths[rows], float))
            for name, (times, rows) in zip(BASELINES, frames, strict=False)
        ]
        mean_pose = np.broadcast_to(truth.mean(axis=0), truth.shape)
        found.append(("mean pose", truth_times, mean_pose))
        self.evaluation.latencies_ms |= dict.fromkeys(BASELINES)
        return found

    def _compared(self, truth: Floats, times: Floats, positions: Floats) -> ClipResult:
        """Compares where both are known; the estimate is taken at the truth's times."""
        truth_times = np.arange(len(truth)) / self.database.rate_hz
        is_known = (truth_times >= times[0] - 1e-6) & (truth_times <= times[-1] + 1e-6)
        if not is_known.any():
            raise TableError(self.database.path, 0, "the performance is too short to compare")
        estimate = interpolated(times, positions, truth_times[is_known])
        errors = joint_errors(truth[is_known], estimate)
        jerk = mean_jerk(positions, self.database.rate_hz)
        return clip_result(errors, frame_errors(errors), jerk)
