# SPDX-License-Identifier: GPL-3.0-or-later
"""The output of ``sparse-mocap database info``."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from .. import Clip, FormatError, MotionDatabase
from .._core import ClipTake

__all__ = ["described", "is_copy", "show"]

_MOST_NAMES, _MOST_FILES, _LONGEST_TEXT = 40, 10, 60


def described(opened: MotionDatabase) -> dict[str, Any]:
    """Returns everything about a database, ready for JSON."""
    clips = opened.clips
    originals = [clip for clip in clips if not is_copy(clip)]
    return {
        "path": opened.path,
        "bytes": Path(opened.path).stat().st_size,
        "array_bytes": opened.array_bytes,
        "frames": opened.num_frames,
        "rate_hz": opened.rate_hz,
        "duration_s": opened.num_frames / opened.rate_hz,
        "joints": list(opened.skeleton.names),
        "sites": list(opened.site_names),
        "num_clips": len(clips),
        "num_mirrored": sum(clip.is_mirrored for clip in clips),
        "num_reversed": sum(clip.is_reversed for clip in clips),
        "num_tempo_copies": sum(clip.tempo != 1.0 for clip in clips),
        "actors": _counts(clip.actor for clip in clips),
        "motion_classes": _counts(clip.motion_class for clip in clips),
        "num_sources": len({clip.source for clip in clips}),
        "source_frames": sum(clip.source_frames for clip in originals),
        "source_hours": sum(map(_source_hours, originals)),
        "takes": [
            _take(clip.take) | {"clip": clip.name} for clip in originals if clip.take is not None
        ],
        "source_hours_by_actor": _hours_by(originals, lambda clip: clip.actor),
        "source_hours_by_class": _hours_by(originals, lambda clip: clip.motion_class),
        "origins": _counts(clip.origin for clip in originals if clip.origin),
        "licenses": _counts(clip.license or "not stated" for clip in originals),
        "skeletons": _skeletons(opened, originals),
        "warnings": _warnings(originals),
        "skipped": [{"source": source, "reason": why} for source, why in opened.skipped],
        "duplicates": [{"source": source, "reason": why} for source, why in opened.duplicates],
        "models": [_model(opened, method) for method in opened.model_names],
        "sections": opened.sections,
        "other_arrays": [_tensor(*info) for info in opened.other_tensors],
        "build": json.loads(opened.build_info),
        "clips": [_clip(clip) for clip in clips],
    }


def _model(opened: MotionDatabase, method: str) -> dict[str, Any]:
    try:
        model = opened.model(method)
    except FormatError as error:
        return {"method": method, "problem": str(error)}
    tensors = [_tensor(*info) for info in model.tensor_infos]
    return {
        "method": method,
        "version": model.version,
        "metadata": model.metadata,
        "bytes": sum(tensor["bytes"] for tensor in tensors),
        "tensors": tensors,
    }


def _tensor(name: str, kind: str, shape: tuple[int, ...], num_bytes: int) -> dict[str, Any]:
    return {"name": name, "type": kind, "shape": list(shape), "bytes": num_bytes}


def is_copy(clip: Clip) -> bool:
    """Whether a clip is a copy of another one: mirrored, reversed or at another tempo."""
    return clip.is_mirrored or clip.is_reversed or clip.tempo != 1.0


def _take(take: ClipTake) -> dict[str, Any]:
    names = ("name", "hash", "begin_s", "correlation", "coverage", "channels")
    return {name: getattr(take, name) for name in names}


def _clip(clip: Clip) -> dict[str, Any]:
    names = (
        "name", "actor", "motion_class", "source", "source_hash", "skeleton_hash", "skeleton",
        "origin", "license", "source_frames", "source_rate_hz", "warnings", "is_mirrored",
        "is_reversed", "tempo", "begin", "end",
    )  # fmt: skip
    take = None if clip.take is None else _take(clip.take)
    return {name: getattr(clip, name) for name in names} | {"take": take}


def _counts(labels: Iterable[str]) -> dict[str, int]:
    return dict(sorted(Counter(labels).items()))


def _source_hours(clip: Clip) -> float:
    return clip.source_frames / clip.source_rate_hz / 3600 if clip.source_rate_hz > 0 else 0.0


def _hours_by(clips: Sequence[Clip], key: Callable[[Clip], str]) -> dict[str, float]:
    hours: dict[str, float] = {}
    for clip in clips:
        hours[key(clip)] = hours.get(key(clip), 0.0) + _source_hours(clip)
    return dict(sorted(hours.items()))


def _skeletons(opened: MotionDatabase, originals: Sequence[Clip]) -> list[dict[str, Any]]:
    counts = Counter(clip.skeleton for clip in originals)
    return [
        {
            "id": skeleton.id,
            "num_joints": skeleton.num_joints,
            "num_files": counts[skeleton.id],
            "unit_scale": skeleton.unit_scale,
            "joints": {
                name: skeleton.joints[name]
                for name in opened.skeleton.names
                if name in skeleton.joints
            },
        }
        for skeleton in opened.skeletons
    ]


def _warnings(originals: Sequence[Clip]) -> list[dict[str, Any]]:
    """The kinds of warnings, most frequent first."""
    counts: Counter[str] = Counter()
    files: Counter[str] = Counter()
    for clip in originals:
        counts.update(clip.warnings)
        files.update(clip.warnings.keys())
    return [
        {"kind": kind, "count": counts[kind], "num_files": files[kind]}
        for kind in sorted(counts, key=lambda kind: (-counts[kind], kind))
    ]


def show(info: Mapping[str, Any]) -> None:
    """Prints the result of described() as text."""
    sizes = (f"{name} {size / 1e6:.1f} MB" for name, size in info["array_bytes"].items())
    rows = {
        "file": f"{info['path']}, {info['bytes'] / 1e6:.1f} MB",
        "arrays": ", ".join(sizes),
        "frames": f"{info['frames']} at {info['rate_hz']:g} Hz, {info['duration_s'] / 60:.1f} min",
        "clips": f"{info['num_clips']}, of which {info['num_mirrored']} mirrored"
        f" and {info['num_reversed']} reversed, {info['num_tempo_copies']} at another tempo",
        "sources": f"{info['num_sources']} files, {info['source_frames']} frames,"
        f" {info['source_hours']:.2f} h",
        "actors": _counted(info["actors"]),
        "classes": _counted(info["motion_classes"]),
        "hours": _hours(info["source_hours_by_actor"]),
        "by class": _hours(info["source_hours_by_class"]),
        "origins": _counted(info["origins"]),
        "licences": _counted(info["licenses"]),
        "sensors": ", ".join(info["sites"]),
        "joints": " ".join(info["joints"]),
        "sections": ", ".join(info["sections"]),
        "build": ", ".join(f"{key} {value}" for key, value in info["build"].items()),
    }
    for name, text in rows.items():
        if text:
            click.echo(f"{name:<8} {text}")
    for skeleton in info["skeletons"]:
        click.echo(f"skeleton {_skeleton_line(skeleton)}")
    for warning in info["warnings"]:
        click.echo(
            f"warning  {warning['kind']}: {warning['count']} times in {warning['num_files']} files"
        )
    for take in info["takes"][:_MOST_FILES]:
        click.echo(f"take     {_take_line(take)}")
    if len(info["takes"]) > _MOST_FILES:
        click.echo(f"take     and {len(info['takes']) - _MOST_FILES} more, see --json")
    for model in info["models"]:
        click.echo(f"model    {_model_line(model)}")
    if info["other_arrays"]:
        click.echo(f"other    {_listed(list(map(_tensor_text, info['other_arrays'])))}")
    for kind in ("skipped", "duplicates"):
        files = info[kind]
        for file in files[:_MOST_FILES]:
            click.echo(f"skipped  {file['reason']}")
        if len(files) > _MOST_FILES:
            click.echo(f"skipped  and {len(files) - _MOST_FILES} more, see --json")


def _skeleton_line(skeleton: Mapping[str, Any]) -> str:
    mapping = " ".join(f"{name}={source}" for name, source in skeleton["joints"].items())
    return (
        f"{skeleton['id']}, {skeleton['num_joints']} joints, {skeleton['num_files']} files,"
        f" unit scale {skeleton['unit_scale']:g}: {mapping}"
    )


def _take_line(take: Mapping[str, Any]) -> str:
    channels = sorted({name for own in take["channels"].values() for name in own})
    return (
        f"{take['clip']} with {take['name']} from {take['begin_s']:.2f} s,"
        f" agreement {take['correlation']:.2f}: {', '.join(channels)} of"
        f" {', '.join(take['channels'])}"
    )


def _model_line(model: Mapping[str, Any]) -> str:
    if "problem" in model:
        return str(model["problem"])
    tensors = _listed(list(map(_tensor_text, model["tensors"]))) or "no tensors"
    texts = "".join(f"; {key}: {_shortened(text)}" for key, text in model["metadata"].items())
    size = model["bytes"] / 1e6
    return f"{model['method']}, version {model['version']}, {size:.1f} MB: {tensors}{texts}"


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST_TEXT else text[: _LONGEST_TEXT - 3] + "..."


def _tensor_text(tensor: Mapping[str, Any]) -> str:
    return f"{tensor['name']} {tensor['type']} {tensor['shape']}"


def _counted(counts: Mapping[str, int]) -> str:
    return _listed([f"{name} ({count})" for name, count in counts.items()])


def _hours(hours: Mapping[str, float]) -> str:
    return _listed([f"{name} {value:.2f} h" for name, value in hours.items()])


def _listed(names: Sequence[str]) -> str:
    more = [f"and {len(names) - _MOST_NAMES} more"] if len(names) > _MOST_NAMES else []
    return ", ".join([*names[:_MOST_NAMES], *more])
