# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take in the scene: an action on each of its characters."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields

import bpy
import numpy as np
from bpy.types import Action, Context, Object

from ..session.bake import PlacedTake
from ..session.errors import InputError
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
    made: list[tuple[str, Action]] = []
    num_parts = len(take.rig_takes) + (figure is not None or not take.rig_takes)
    share, new_figure = 1.0 / num_parts, None
    figure_name = figure.name if figure is not None else ""
    with selection_back_on_error(context):
        try:
            for number, rig_take in enumerate(take.rig_takes):
                armature = editable(_armature(rig_take.target.armature))
                name = _action_name(take, rig_take)
                reduction = _reduction(take, rig_take.target.controls.units_per_metre)
                steps = rig_action_steps(name, armature, rig_take, take.frames, reduction)
                made.append((armature.name, (yield from part(steps, number * share, share))))
            if num_parts > len(take.rig_takes):
                if figure_name:
                    rig = rig_of(_armature(figure_name), take.motion.skeleton)
                else:
                    rig = new_armature(context, take.motion.skeleton)
                    new_figure = rig.armature
                reduction = _reduction(take, rig.units_per_metre)
                name = take.performance.name
                steps = action_steps(name, rig, take.motion, take.frames, reduction)
                made.append((rig.armature.name, (yield from part(steps, 1.0 - share, share))))
                use_quaternions(rig.armature)
        except BaseException:
            remove_actions([action for _, action in made])
            if new_figure is not None:
                remove_armature(new_figure)
            raise
    return _assign(context, take, made)


def _reduction(take: PlacedTake, units_per_metre: float) -> Reduction | None:
    errors = take.placement.largest_errors
    return Reduction(errors[0], 0.01 * errors[1] * units_per_metre) if errors is not None else None


def _assign(context: Context, take: PlacedTake, made: list[tuple[str, Action]]) -> Object:
    match = take.performance.match
    facts = Facts(
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
    )
    for name, action in made:
        action[_FACTS] = asdict(facts)
        armature = bpy.data.objects[name]
        assign_action(armature, action)
    select_only(context, armature)
    return armature


def replace_actions(names: dict[str, str]) -> None:
    """Let the characters' new actions have the names of those that they had, which are removed.

    names: by armature, of actions that this add-on made.
    """
    for armature, name in names.items():
        old, new = bpy.data.actions.get(name), performed_action(bpy.data.objects.get(armature))
        if old is not None and new is not None and new != old and facts_of(old) is not None:
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
