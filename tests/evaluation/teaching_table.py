# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes TEACHING.md: what a performer's own clips bring, with and without the takes to them.

teaching_table.py HDM05 [-o TEACHING.md] [--every N] [--tune] [--sensors forces|gyroscopes]

HDM05 is a folder of recorded motion. Each performer is new to the database, but for one own clip of
each movement. With --tune it only prints how the preference of real readings changes the errors of
other clips than those that are reported; --every N takes every N-th clip.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sparse_mocap import (
    ConfigError,
    Motion,
    MotionDatabase,
    NoiseModel,
    _core,
    build_database,
    noise_presets,
    noisy,
    read_motion,
    reconstruct,
    simulated,
    to_standard,
    write_bvh,
    write_take,
)
from sparse_mocap.evaluation.comparison import Estimate, Truth
from sparse_mocap.evaluation.protocol import is_copy
from sparse_mocap.labels import find_labels
from sparse_mocap.motion_files import read_options
from sparse_mocap.reconstruction import sensor_recordings, used_sensors
from sparse_mocap.rotations import from_rotation_vectors, product
from sparse_mocap.take import SensorRecord, Take
from sparse_mocap.teaching import Pairing, pair_take
from sparse_mocap.workers import processors

Floats = NDArray[np.float64]

TEACHING = Path(__file__).with_name("TEACHING.md")
SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
RATE_HZ = 100.0
WRONG_BY_M = 0.1
PREFERENCES = (0.0, 0.15, 0.3, 0.45, 0.6)

HEAD = """# Teaching

How far reconstructed joints are off when the performer is new to the database but has taught it
one own clip of each movement: as a motion alone (`database add`), and together with the take that
sensors recorded during it (`database add --take`). `tests/evaluation/teaching_table.py HDM05`
writes this file.

- Error: RMS over the joints in the heading frame, in cm, mean over each clip's frames, then over
  clips. Every test is a clip of which the performer has a second one, which teaches.
- Sensors: four, with consumer noise; how they are turned on the body, their bias, scale and delay
  are a performer's own, and the same in both takes (`worn alike`) or drawn anew (`strapped on
  anew`). `Worn elsewhere`: 70 % of the way along the forearms and 45 % along the shanks.
- Wrong poses: smooth turns of all joints put the taught poses off by 10 cm, as a video might.
- Other movements: all own clips but those of the tested movement.
- Rows with real readings count as all others do; `--tune` shows, on other clips, what it would
  change to prefer them.
"""


@dataclass(frozen=True)
class Own:
    """A performer's clips of one movement."""

    actor: str
    movement: str
    test: Path
    teacher: Path
    tuning: Path | None


@dataclass(frozen=True)
class Worn:
    """How a performer wears the sensors."""

    along: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)
    strapped: int = 0
    """Which time they are strapped on; the taught takes are of the time 0."""


def own_clips(folder: Path) -> list[Own]:
    """The movements of which a performer has a second clip."""
    files: dict[tuple[str, str], list[Path]] = {}
    for path in sorted(folder.glob("HDM_*.amc")):
        _, actor, movement, *_ = path.stem.split("_")
        files.setdefault((actor, movement), []).append(path)
    return [
        Own(*key, paths[0], paths[1], paths[2] if len(paths) > 2 else None)
        for key, paths in sorted(files.items())
        if len(paths) > 1
    ]


def recorded(path: Path, actor: str, worn: Worn, channels: Sequence[str]) -> Take:
    """What the performer's sensors would record during a motion file."""
    motion, _ = to_standard(read_motion(path)[0])
    ideal = simulated(motion, SITES, RATE_HZ, worn.along)
    model = noise_presets()["consumer"]
    seed = sum(map(ord, actor)) + 1000 * worn.strapped
    silent = replace(model, accelerometer_density=0.0, gyroscope_density=0.0)
    white = NoiseModel(
        accelerometer_density=model.accelerometer_density,
        gyroscope_density=model.gyroscope_density,
    )
    take = noisy(noisy(ideal, silent, seed), white, sum(map(ord, path.stem)))
    return Take({site: _seen(record, channels) for site, record in take.sensors.items()})


def _seen(record: SensorRecord, channels: Sequence[str]) -> SensorRecord:
    turns = record.angular_velocity if "gyroscopes" in channels else None
    return SensorRecord(record.times_s, record.specific_force, turns)


def disturbed(motion: Motion, seed: int) -> Motion:
    """The motion with all joints turned smoothly, so that joints are WRONG_BY_M off on average."""
    chance = np.random.default_rng(seed)
    rotations = np.array(motion.rotations)
    frames, joints = rotations.shape[:2]
    knots_s = 1.0
    count = int(frames * motion.frame_time_s / knots_s) + 3
    at = np.arange(frames) * motion.frame_time_s / knots_s
    knots = chance.normal(size=(count, joints, 3))
    low = at.astype(int)
    part = (0.5 - 0.5 * np.cos(np.pi * (at - low)))[:, None, None]
    turns = (1.0 - part) * knots[low] + part * knots[low + 1]
    turns[:, 0] = 0.0
    true = np.asarray(motion.joint_positions("heading"))
    size = 0.15
    for _ in range(8):
        turned = np.stack(
            [
                product(rotations[:, j], from_rotation_vectors(size * turns[:, j]))
                for j in range(joints)
            ],
            axis=1,
        )
        made = Motion(motion.skeleton, motion.frame_time_s, motion.root_positions, turned)
        apart = np.asarray(made.joint_positions("heading")) - true
        off_m = float(np.sqrt((apart**2).sum(-1).mean(-1)).mean())
        size *= WRONG_BY_M / off_m
    return made


class Lessons:
    """Databases that know a performer's own clips in some way."""

    def __init__(self, source: Path, folder: Path, channels: Sequence[str], worn: Worn) -> None:
        self.folder, self.channels, self.worn = folder, channels, worn
        self.base = folder / "base.smdb"
        self.pairings: list[Pairing] = []
        self.refused: list[str] = []
        if not self.base.exists():
            build_database([source], self.base, mirror=True)
        self.own = own_clips(source)

    def database(self, actor: str, *, paired: bool, wrong: bool) -> MotionDatabase:
        """The base with the performer's teachers as they are asked for."""
        along = "_".join(f"{along:g}" for along in self.worn.along)
        name = f"{actor}_{paired:d}{wrong:d}_{'_'.join(self.channels)}_{along}.smdb"
        path = self.folder / name
        if not path.exists():
            files = [self._taught(one, wrong) for one in self.own if one.actor == actor]
            takes: dict[str | os.PathLike[str], _core.PairedTake] = {}
            if paired:
                takes = {file: self._paired(file, one) for file, one in files}
            sources = [file for file, _ in files]
            labels, _ = find_labels(sources, (), None)
            _core.add_to_database(
                self.base, sources, path, labels=labels, takes=takes, read=read_options()
            )
        return MotionDatabase(path)

    def _taught(self, one: Own, wrong: bool) -> tuple[Path, Own]:
        if not wrong:
            return one.teacher, one
        path = self.folder / f"{one.teacher.stem}.bvh"
        if not path.exists():
            motion, _ = to_standard(read_motion(one.teacher)[0])
            write_bvh(path, disturbed(motion, sum(map(ord, path.stem))))
        return path, one

    def _paired(self, file: Path, one: Own) -> _core.PairedTake:
        """The take as the database takes it; aligned by a clap where it cannot be without."""
        path = self.folder / f"{one.teacher.stem}.csv"
        take = recorded(one.teacher, one.actor, self.worn, self.channels)
        write_take(path, take)
        try:
            pairing, paired = pair_take(file, path)
        except ConfigError as error:
            self.refused.append(str(error))
            sensors = used_sensors(take, None, None, True)
            return _core.PairedTake(
                path.name,
                file.name,
                sensors,
                sensor_recordings(take),
                begin_s=noise_presets()["consumer"].latency_s,
                correlation=0.0,
            )
        self.pairings.append(pairing)
        return paired


def allowed(database: MotionDatabase, one: Own, own: Sequence[str]) -> list[int]:
    """The clips to hide: the performer's, but for those made from these files."""
    return [
        index
        for index, clip in enumerate(database.clips)
        if clip.actor == one.actor and clip.source not in own
    ]


def error_cm(
    database: MotionDatabase,
    test: Path,
    take: Take,
    hidden: Sequence[int],
    options: Any,
    best: bool,
) -> float:
    """The error of a reconstruction of the test clip."""
    clip = next(c for c in database.clips if c.source == test.name and not is_copy(c))
    motion, _ = to_standard(read_motion(test)[0])
    performed = to_standard(motion, database.skeleton)[0].resampled(database.rate_hz)
    truth = Truth(database, clip, performed, np.arange(performed.num_frames) / database.rate_hz)
    solved = reconstruct(
        take, database, best_quality=best, excluded_clips=hidden, options=options or {}
    )
    found, _ = to_standard(solved.motion.without_extremities(), database.skeleton)
    estimate = Estimate(
        "",
        np.asarray(solved.readings.times_s),
        np.asarray(found.joint_positions("heading")),
        np.asarray(found.joint_positions("root")),
    )
    return truth.compared(estimate).mean_cm


def teachers(lessons: Lessons, one: Own, *, wrong: bool, others: bool) -> list[str]:
    """The sources of the own clips that a test's database has."""
    suffix = ".bvh" if wrong else ".amc"
    return [
        f"{known.teacher.stem}{suffix}"
        for known in lessons.own
        if known.actor == one.actor and not (others and known.movement == one.movement)
    ]


ROWS = {
    "no own clip": None,
    "own clips": (False, False, False),
    "own clips with their takes": (True, False, False),
    "own clips, poses wrong by 10 cm": (False, True, False),
    "own clips with their takes, poses wrong by 10 cm": (True, True, False),
    "own clips of other movements": (False, False, True),
    "own clips of other movements with their takes": (True, False, True),
}


def errors_of(
    lessons: Lessons,
    clips: Sequence[tuple[Own, Path]],
    take_worn: Worn,
    rows: Sequence[str],
    options: Mapping[str, Any] | None = None,
) -> dict[str, tuple[list[float], list[float]]]:
    """By row, the errors of the clips in best quality and live."""
    found: dict[str, tuple[list[float], list[float]]] = {row: ([], []) for row in rows}
    jobs = []
    with processors(2) as workers:
        for one, test in clips:
            take = recorded(test, one.actor, take_worn, lessons.channels)
            for row in rows:
                paired, wrong, others = ROWS[row] or (False, False, False)
                database = lessons.database(one.actor, paired=paired, wrong=wrong)
                own = teachers(lessons, one, wrong=wrong, others=others) if ROWS[row] else []
                hidden = allowed(database, one, own)
                for best in (True, False):
                    jobs.append(
                        (
                            row,
                            best,
                            workers.submit(error_cm, database, test, take, hidden, options, best),
                        )
                    )
        for row, best, job in jobs:
            found[row][0 if best else 1].append(job.result())
    return found


def table(found: Mapping[str, tuple[list[float], list[float]]]) -> Iterator[str]:
    """The rows as Markdown: means, and the gain over no own clip with its standard error."""
    yield "| known of the performer | best quality | live |"
    yield "|---|---|---|"
    for row, errors in found.items():
        yield f"| {row} | {' | '.join(f'{np.mean(own):.2f}' for own in errors)} |"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description="Writes TEACHING.md.")
    parser.add_argument("source", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=TEACHING)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--tune", action="store_true")
    arguments = parser.parse_args()
    folder = arguments.folder or Path(tempfile.mkdtemp(prefix="sparse_mocap_"))
    folder.mkdir(exist_ok=True)
    if arguments.tune:
        tune(arguments.source, folder, arguments.every)
        return
    text = [HEAD]
    for channels, name in ((("forces",), "Accelerometers"), (("gyroscopes",), "Gyroscopes too")):
        for title, worn, anew in (
            ("worn alike", Worn(), 0),
            ("strapped on anew", Worn(), 1),
            ("worn elsewhere", Worn((0.7, 0.7, 0.45, 0.45)), 0),
        ):
            lessons = Lessons(arguments.source, folder, channels, worn)
            clips = [(one, one.test) for one in lessons.own][:: arguments.every]
            found = errors_of(lessons, clips, replace(worn, strapped=anew), list(ROWS))
            text += [f"## {name}, {title} ({len(clips)} clips)", "", *table(found), ""]
            print("\n".join(text[-len(found) - 4 :]), flush=True)
    arguments.output.write_text("\n".join(text), encoding="utf-8")


def tune(source: Path, folder: Path, every: int) -> None:
    """Prints the errors of the tuning clips by the preference of real readings."""
    for channels in (("forces",), ("gyroscopes",)):
        lessons = Lessons(source, folder, channels, Worn())
        clips = [(one, one.tuning) for one in lessons.own if one.tuning is not None][::every]
        rows = [row for row in ROWS if "with their takes" in row]
        for preference in PREFERENCES:
            for strapped in (0, 1):
                found = errors_of(
                    lessons,
                    clips,
                    Worn(strapped=strapped),
                    rows,
                    {"real_preference": preference},
                )
                print(channels, f"preference {preference}, strapped {strapped}", flush=True)
                print("\n".join(table(found)), flush=True)


if __name__ == "__main__":
    main()
