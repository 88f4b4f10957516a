# SPDX-License-Identifier: GPL-3.0-or-later
"""Learns from a database itself what good and poor reconstructions look like (see quality).

Some of its clips are reconstructed from the others: without themselves, without their performers,
and without their kinds of movement.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence

import numpy as np

from ._core import Clip, MotionDatabase, store_section
from .quality import NUM_JOINTS, SECTION, USUAL, VERSION, Evidence, Floats, evidence_of, measures_of
from .reconstruction import reconstruct
from .take import SensorRecord, Take
from .workers import processors

__all__ = ["calibrate_quality"]

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")

_SHARE = 0.025  # of the database's frames that are reconstructed for a calibration,
_MOST_FRAMES = 4500  # which need not grow with the database for good
_LONGEST_S, _FEWEST_CLIPS = 5.0, 20
_SETTLES = slice(8, -4)  # frames of a clip in which its neighbours in a row of clips are not felt
_TRUST = 20.0  # how many reconstructions what is usual counts for


def calibrate_quality(database: str | os.PathLike[str]) -> None:
    """Learns what good and poor reconstructions look like in a database, and keeps it there.

    A few of its clips are reconstructed thrice: without themselves, without their performers, and
    without their kinds of movement. Databases of a few clips are left alone. Raises FormatError and
    OSError.
    """
    opened = MotionDatabase(database)
    rows, logarithms, typical = [], [], []
    held_out = _held_out(opened)
    with processors() as workers:
        begun = [workers.submit(_reconstructed, opened, *held[1:]) for held in held_out]
        found = [reconstructed.result() for reconstructed in begun]
    for (kind, *_), reconstructions in zip(held_out, found, strict=True):
        for evidence, share in reconstructions:
            rows.append(measures_of(evidence))
            logarithms.append(np.log(share))
            if kind == "source":
                typical.append((evidence.spread_m.mean(), evidence.misfit_mps2.mean()))
    if not typical:
        return
    measures = np.array(rows)
    residuals = np.array(logarithms) - measures @ np.array(USUAL)
    scatter = measures.T @ measures / len(measures)
    change = np.linalg.solve(
        measures.T @ measures + _TRUST * (scatter + 1e-6 * np.eye(len(USUAL))),
        measures.T @ residuals,
    )
    spread_m, misfit_mps2 = np.median(typical, axis=0)
    learned = {
        "coefficients": [float(value) for value in np.array(USUAL) + change],
        "spread_m": float(spread_m),
        "misfit_mps2": float(misfit_mps2),
    }
    store_section(
        database,
        SECTION,
        {"calibration": json.dumps(learned)},
        version=VERSION,
        rows=opened.rows_hash,
    )


def _held_out(database: MotionDatabase) -> list[tuple[str, list[int], list[int]]]:
    """Returns what is held out, clips to reconstruct, and the clips that are hidden then."""
    clips = database.clips
    originals = [
        i for i, c in enumerate(clips) if not (c.is_mirrored or c.is_reversed or c.tempo != 1.0)
    ]
    if len(originals) < _FEWEST_CLIPS:
        return []
    chance = np.random.default_rng(0)
    frames = min(_SHARE * database.num_frames, _MOST_FRAMES) / 3.0
    found = []
    for kind in ("source", "actor", "motion_class"):
        labels = [getattr(clip, kind) for clip in clips]
        names = sorted({labels[i] for i in originals})
        if len(names) < 2:
            continue
        hidden = set(chance.permutation(names)[: max(1, len(names) // 2)].tolist())
        tests: list[int] = []
        for i in chance.permutation([i for i in originals if labels[i] in hidden]).tolist():
            if sum(_length(database, clips[k]) for k in tests) < frames:
                tests.append(i)
        if kind == "source":
            hidden = {labels[i] for i in tests}
        excluded = [i for i, label in enumerate(labels) if label in hidden]
        if tests and len(excluded) < len(clips):
            found.append((kind, sorted(tests), excluded))
    return found


def _length(database: MotionDatabase, clip: Clip) -> int:
    return min(clip.end - clip.begin, round(_LONGEST_S * database.rate_hz))


def _reconstructed(
    database: MotionDatabase, tests: Sequence[int], excluded: Sequence[int]
) -> list[tuple[Evidence, float]]:
    """Returns what is said of each clip, and its error as a part of the mean pose's.

    All are performed one after the other in one take, so that the database is prepared once.
    """
    lengths = [_length(database, database.clips[i]) for i in tests]
    rows = np.concatenate(
        [database.clips[i].begin + np.arange(n) for i, n in zip(tests, lengths, strict=True)]
    )
    forces, names = database.array("specific_force_end"), list(database.site_names)
    times_s = np.arange(len(rows)) / database.rate_hz
    columns = {site: 3 * names.index(site) for site in SITES}
    take = Take(
        {
            site: SensorRecord(times_s, forces[rows][:, at : at + 3].astype(float))
            for site, at in columns.items()
        }
    )
    solved = reconstruct(take, database, excluded_clips=excluded, use_gyroscopes=False)
    numbers = np.round(np.asarray(solved.readings.times_s) * database.rate_hz).astype(int)
    poses = np.asarray(solved.motion.joint_positions("heading"))[:, :NUM_JOINTS]
    truth = database.array("positions")[rows].reshape(len(rows), -1, 3).astype(float)
    found, begin = [], 0
    for length in lengths:
        inner = range(begin, begin + length)[_SETTLES]
        at = np.flatnonzero((numbers >= inner.start) & (numbers < inner.stop))
        begin += length
        if len(at) < 2:
            continue
        wanted = truth[numbers[at]]
        mean = truth[inner.start : inner.stop].mean(axis=0)
        error, held = (_error_m(wanted, estimate) for estimate in (poses[at], mean))
        part = slice(int(at[0]), int(at[-1]) + 1)
        if error > 0.0 and held > 0.0:
            found.append((evidence_of(solved, part), error / held))
    return found


def _error_m(truth: Floats, estimate: Floats) -> float:
    return float(np.sqrt(((truth - estimate) ** 2).sum(axis=-1).mean(axis=-1)).mean())
