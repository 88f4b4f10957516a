# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take in the scene: an action on each of its characters."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace
from uuid import uuid4

import bpy
import numpy as np
from bpy.types import Action, Context, Object

from ..session.bake import PlacedTake
from ..session.errors import InputError
from ..session.reconstruct import differences_text
from ..session.retarget import RigTake
from ..session.steps import Steps, part
from .action import Reduction, action_steps
from .armature import (
    editable,
    new_armature,
    remove_armature,
    rig_of,
    select_only,
    selection_back_on_error,
    use_quaternions,
)
from .compat import assign_action
from .imported import remove_actions
from .rig_action import rig_action_steps

_FACTS = "sparse_mocap"  # custom property of actions that this add-on made


@dataclass(frozen=True)
class Facts:
    """What the panel shows of an action."""

    duration_s: float
    match: str
    is_guess: bool
    take: str
    """The name of its take."""
    first_frame: float = 1.0
    begin_s: float = 0.0
    """The time in the take that is on the first frame."""
    frames_per_s: float = 0.0
    """0: unknown."""
    seconds: str = ""
    """Of the take: good, fair or poor for each, separated by spaces."""
    advice: str = ""
    """What would help."""
    odd_sensor: str = ""
    """The location of a sensor that fits far worse than the others."""
    letter: str = "A"
    """A, or B and C for alternatives of the take."""
    differences: str = ""
    """Where an alternative differs from A, and by how much."""
    group: str = ""
    """The same for a character's actions that are alternatives of each other."""

    def time_s(self, frame: float) -> float:
        """The time in the take at a frame of the scene; NaN where it is unknown."""
        if self.frames_per_s <= 0.0:
            return float("nan")
        return self.begin_s + (frame - self.first_frame) / self.frames_per_s

    def frame_at(self, time_s: float) -> float:
        """The frame of the scene at a time in the take."""
        return self.first_frame + (time_s - self.begin_s) * self.frames_per_s


def perform_steps(context: Context, take: PlacedTake, figure: Object | None) -> Steps[Object]:
    """The last character with the take's action, active and alone selected.

    figure: the add-on's own figure to use; None: a new one, unless the take has characters.
    Raises InputError or ValueError; the scene is then unchanged, also when closed early.
    """
    made: list[_Made] = []
    versions = (take, *take.alternatives)
    share, new_figure = 1.0 / len(versions), None
    figure_name = figure.name if figure is not None else ""
    with selection_back_on_error(context):
        try:
            if not figure_name and not take.rig_takes:
                new_figure = new_armature(context, take.motion.skeleton).armature
                figure_name = new_figure.name
            for number, version in enumerate(versions):
                steps = _making_steps(version, figure_name, made)
                yield from part(steps, number * share, share)
        except BaseException:
            remove_actions([action for _, action, _ in made])
            if new_figure is not None:
                remove_armature(new_figure)
            raise
    return _assign(context, made)


_Made = tuple[str, Action, PlacedTake]
"""An armature's name, the action that was made for it, and what it is of."""


def _making_steps(take: PlacedTake, figure_name: str, made: list[_Made]) -> Steps[None]:
    """Makes the actions of the characters and the figure, if there is one, and adds them."""
    share = 1.0 / (len(take.rig_takes) + bool(figure_name))
    for number, rig_take in enumerate(take.rig_takes):
        armature = editable(_armature(rig_take.target.armature))
        name = _action_name(take, rig_take)
        reduction = _reduction(take, rig_take.target.controls.units_per_metre)
        steps = rig_action_steps(name, armature, rig_take, take.frames, reduction)
        made.append((armature.name, (yield from part(steps, number * share, share)), take))
    if figure_name:
        rig = rig_of(_armature(figure_name), take.motion.skeleton)
        reduction = _reduction(take, rig.units_per_metre)
        name = take.performance.name
        figure_steps = action_steps(name, rig, take.motion, take.frames, reduction)
        action = yield from part(figure_steps, 1.0 - share, share)
        made.append((rig.armature.name, action, take))
        use_quaternions(rig.armature)


def _reduction(take: PlacedTake, units_per_metre: float) -> Reduction | None:
    errors = take.placement.largest_errors
    return Reduction(errors[0], 0.01 * errors[1] * units_per_metre) if errors is not None else None


def _assign(context: Context, made: list[_Made]) -> Object:
    """Let each character play its first action; returns the last character."""
    played: dict[str, Action] = {}
    run = uuid4().hex
    for name, action, take in made:
        action[_FACTS] = asdict(replace(_facts(take), group=f"{run} {name}"))
        if name not in played:
            played[name] = action
            assign_action(bpy.data.objects[name], action)
    armature = bpy.data.objects[list(played)[-1]]
    select_only(context, armature)
    return armature


def _facts(take: PlacedTake) -> Facts:
    performance, match = take.performance, take.performance.match
    return Facts(
        take.performance.duration_s,
        match.label,
        match.is_guess,
        take.performance.name,
        take.placement.start_frame,
        take.placement.part_s[0] if take.placement.part_s is not None else 0.0,
        take.placement.scene_rate_hz,
        " ".join(match.seconds),
        match.advice,
        match.odd_sensor,
        performance.letter,
        differences_text(performance.differences),
    )


def alternatives_of(action: Action) -> dict[str, Action]:
    """The alternatives that an action of a take belongs to, by letter; none if it is the only one.

    Itself is among them.
    """
    facts = facts_of(action)
    if facts is None or not facts.group:
        return {}
    found = {}
    for other in bpy.data.actions:
        others = facts_of(other)
        if others is not None and others.group == facts.group:
            found[others.letter] = other
    return dict(sorted(found.items())) if len(found) > 1 else {}


def replace_actions(names: dict[str, str]) -> None:
    """Let the characters' new actions have the names of those that they had, which are removed.

    names: by armature, of actions that this add-on made.
    """
    for armature, name in names.items():
        old, new = bpy.data.actions.get(name), performed_action(bpy.data.objects.get(armature))
        if old is None or new is None or new == old:
            continue
        before, now = facts_of(old), facts_of(new)
        if before is not None and now is not None:
            new[_FACTS] = asdict(replace(now, group=before.group))
            bpy.data.actions.remove(old)
            new.name = name


def extend_scene(context: Context, take: PlacedTake) -> None:
    """Let the scene end no earlier than the take."""
    if len(take.frames):
        scene = context.scene
        scene.frame_end = max(scene.frame_end, int(np.ceil(take.frames[-1])))


def facts_of(action: Action) -> Facts | None:
    """The facts stored with the action, if this add-on made it."""
    values = action.get(_FACTS)
    if not hasattr(values, "to_dict"):
        return None
    names = {field.name for field in fields(Facts)}
    known = {name: value for name, value in values.to_dict().items() if name in names}
    try:
        return Facts(**known)
    except TypeError:  # another version's
        return None


def performed_action(obj: Object | None) -> Action | None:
    """The action that a character plays."""
    if obj is None or obj.type != "ARMATURE" or obj.animation_data is None:
        return None
    return obj.animation_data.action


def _armature(name: str) -> Object:
    armature = bpy.data.objects.get(name)
    if armature is None:
        raise InputError(f'The character "{name}" is gone: choose another one')
    return armature


def _action_name(take: PlacedTake, rig_take: RigTake) -> str:
    is_only = len(take.rig_takes) == 1
    return (
        take.performance.name if is_only else f"{take.performance.name} {rig_take.target.armature}"
    )
