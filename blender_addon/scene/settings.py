# SPDX-License-Identifier: GPL-3.0-or-later
"""The animator's settings, saved in the scene."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, Object, PropertyGroup, Scene

from ..session.methods import (
    Items,
    MethodChoice,
    choice_of,
    method_items,
    preset_items,
    written_options,
)
from .preferences import PERSONAL, delegating, own_property
from .teaching import SPARSEMOCAP_PG_teaching
from .training import SPARSEMOCAP_PG_training

_kept_items: dict[str, Items] = {}
"""Blender does not keep the texts of menus that are made on the fly; this does."""


def _kept(key: str, items: Items) -> Items:
    _kept_items[key] = items or [("default", "Default", "The default settings")]
    return _kept_items[key]


def _methods(_: PropertyGroup, __: Context) -> Items:
    return _kept("methods", method_items())


def _presets(settings: PropertyGroup, _: Context) -> Items:
    return _kept(f"presets of {settings.method}", preset_items(settings.method))


def _is_armature(_: PropertyGroup, obj: Object) -> bool:
    return obj.type == "ARMATURE"


class SPARSEMOCAP_PG_port(PropertyGroup):
    """A further port and the protocol of the sensors at it."""


SPARSEMOCAP_PG_port.__annotations__ = {
    name: own_property(name) for name in ("port", "driver", "baud", "driver_options")
}


class SPARSEMOCAP_PG_source(PropertyGroup):
    """Another folder or motion file."""

    path: StringProperty(name="Path", description="A folder of motion files, or a single file")


class SPARSEMOCAP_PG_option(PropertyGroup):
    """An option of the method and the value to use instead of the default."""

    name: StringProperty(name="Option")
    value: StringProperty(name="Value", description="The value to use; press X for the default")


class SPARSEMOCAP_PG_take(PropertyGroup):
    """A recorded take of the scene; its samples are in its file."""

    name: StringProperty(name="Take")
    path: StringProperty(name="File", description="The take (.csv), relative to the .blend file")
    duration_s: FloatProperty(name="Length", description="In s")
    num_sensors: IntProperty(name="Sensors")
    match: StringProperty(name="Match", description="How well its last reconstruction matched")
    letters: StringProperty(
        name="Alternatives", description="The motions found by the last reconstruction of this take"
    )
    is_starred: BoolProperty(name="Star", description="Mark a good take")


def _choose_take(settings: PropertyGroup, _: Context) -> None:
    if 0 <= settings.take_index < len(settings.takes):
        settings.take = settings.takes[settings.take_index].path


class SPARSEMOCAP_PG_settings(PropertyGroup):
    """The settings of one scene."""

    takes: CollectionProperty(type=SPARSEMOCAP_PG_take)
    take_index: IntProperty(name="Take", update=_choose_take)
    use_range: BoolProperty(
        name="Use a part", description="Use only a part of the take, from one time to another"
    )
    range_begin_s: FloatProperty(
        name="From (s)",
        description="Where the part begins, in s from the take's beginning",
        min=0.0,
    )
    range_end_s: FloatProperty(
        name="To (s)",
        description="Where the part ends, in s from the take's beginning. 0: at its end",
        min=0.0,
    )
    smooth_s: FloatProperty(
        name="Smooth (s)",
        description="Standard deviation of a Gaussian filter over the motion, in s. 0: none",
        min=0.0,
        max=1.0,
        precision=3,
        step=1,
    )
    reduce_keys: BoolProperty(
        name="Reduce keys",
        description="Leave out keys while the motion stays within the errors below",
    )
    largest_error_deg: FloatProperty(
        name="Error (°)",
        description="How far a bone's rotation may be off between keys, in degrees",
        default=0.5,
        min=0.0,
        max=20.0,
    )
    largest_error_cm: FloatProperty(
        name="Error (cm)",
        description="How far a bone's location may be off between keys, in cm",
        default=0.2,
        min=0.0,
        max=20.0,
    )

    source: StringProperty(
        name="Folder",
        description="Folder with motion files (.bvh, or .amc with .asf) and subfolders",
        subtype="DIR_PATH",
    )
    more_sources: CollectionProperty(type=SPARSEMOCAP_PG_source)
    output: StringProperty(
        name="Save as",
        description="The database file to write. Empty: next to the folder, with its name",
    )
    mirror: BoolProperty(
        name="Mirror",
        description="Also add a mirrored copy of every motion, for twice as many motions",
        default=True,
    )
    reverse: BoolProperty(name="Reverse", description="Also add a reversed copy of every motion")
    tempos: BoolProperty(
        name="Other tempos",
        description="Also add slower (0.8x) and faster (1.25x) copies while the database is small",
        default=True,
    )
    rate_hz: FloatProperty(
        name="Frame rate",
        description="Frames per second of the database; takes are reconstructed at this rate",
        default=25.0,
        min=5.0,
        max=120.0,
        precision=1,
    )
    strict: BoolProperty(
        name="Stop at the first error",
        description="Build nothing if a file cannot be used. Off: the file is skipped and listed",
    )
    exclude: StringProperty(
        name="Exclude",
        description="File names to exclude, separated by commas, for example: *_02.bvh, test*",
    )
    is_build_open: BoolProperty(
        name="Build from motion files", description="Build another motion database"
    )
    take: StringProperty(name="Take", description="The recorded take (.csv) to reconstruct")
    method: EnumProperty(name="Method", description="How motion is reconstructed", items=_methods)
    preset: EnumProperty(name="Preset", description="The settings of the method", items=_presets)
    options: CollectionProperty(type=SPARSEMOCAP_PG_option)
    offline: BoolProperty(
        name="Best quality",
        description=(
            "Use the whole take for every frame: more accurate and smoother, but slower. "
            "Off: the same as in a live preview"
        ),
        default=True,
    )
    alternatives: BoolProperty(
        name="Alternatives",
        description=(
            "Also find up to two other motions, B and C, that fit the sensors almost as well. "
            "Only in best quality; takes longer"
        ),
    )
    start_frame: FloatProperty(
        name="Start frame",
        description="The scene frame on which the take starts",
        default=1.0,
        precision=0,
        step=100,
    )
    reuse_armature: BoolProperty(
        name="Reuse armature",
        description="Put the action on a Sparse Mocap armature in this scene, not on a new one",
    )
    target: PointerProperty(
        name="Character",
        description=(
            "The armature that live previews and takes move. Empty: a figure of the add-on's own"
        ),
        type=Object,
        poll=_is_armature,
    )
    to_selected: BoolProperty(
        name="Also on selected",
        description="Also put takes on the other selected armatures",
    )
    limbs: EnumProperty(
        name="Limbs",
        description="Which controls of a rig that has both get the keys of arms and legs",
        items=(
            ("FK", "FK", "Arms and legs by their FK controls"),
            ("LEGS", "Legs IK", "Legs by their IK controls, arms by their FK controls"),
            ("IK", "IK", "Arms and legs by their IK controls"),
        ),
    )
    floor: PointerProperty(
        name="Floor",
        description=(
            "The object at whose height the feet stand. Empty: the height of the character's origin"
        ),
        type=Object,
    )
    foot_lock: FloatProperty(
        name="Foot lock",
        description="How far feet stay where they stand: 0 as reconstructed, 1 without any sliding",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    least_certainty: FloatProperty(
        name="Certainty",
        description="How certain a contact with the floor has to be for the foot to be locked",
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    fastest_foot_mps: FloatProperty(
        name="Speed (m/s)",
        description="Feet that move faster are not locked (m/s)",
        default=0.7,
        min=0.0,
        max=3.0,
    )
    highest_foot_m: FloatProperty(
        name="Highest (m)",
        description="Feet that are higher above the floor are not locked (m)",
        default=0.06,
        min=0.0,
        max=0.5,
    )
    whole_frames: BoolProperty(
        name="Whole frames",
        description=(
            "Keys on every whole frame of the scene. Off: keys at the take's own times, which "
            "usually lie between frames"
        ),
        default=True,
    )
    extend_scene: BoolProperty(
        name="Extend scene",
        description="Move the scene's end if the take would end after it",
    )
    countdown_s: IntProperty(
        name="Countdown (s)",
        description="Seconds before a recording starts, shown in large letters",
        default=3,
        min=0,
        max=60,
    )
    record_plays: BoolProperty(
        name="Play timeline",
        description=(
            "Play the timeline and its sound while recording. "
            "The take then starts on the frame where the recording began"
        ),
    )
    in_place: BoolProperty(
        name="In place", description="Keep the live character at the origin while it moves"
    )
    more_ports: CollectionProperty(type=SPARSEMOCAP_PG_port)
    training: PointerProperty(type=SPARSEMOCAP_PG_training)
    teaching: PointerProperty(type=SPARSEMOCAP_PG_teaching)


SPARSEMOCAP_PG_settings.__annotations__ |= {name: delegating(name) for name in PERSONAL}


def settings_of(scene: Scene) -> SPARSEMOCAP_PG_settings:
    """The scene's settings."""
    return scene.sparse_mocap


def options_text(settings: SPARSEMOCAP_PG_settings) -> str:
    """The options that differ from the method's defaults, as operators take them."""
    return written_options([(option.name, option.value) for option in settings.options])


def scene_choice(scene: Scene) -> MethodChoice:
    """The method that the scene's settings name. Raises InputError."""
    settings = settings_of(scene)
    model = bpy.path.abspath(settings.training.model)
    return choice_of(settings.method, settings.preset, options_text(settings), model)[0]


def register() -> None:
    """Register the settings."""
    bpy.utils.register_class(SPARSEMOCAP_PG_source)
    bpy.utils.register_class(SPARSEMOCAP_PG_port)
    bpy.utils.register_class(SPARSEMOCAP_PG_option)
    bpy.utils.register_class(SPARSEMOCAP_PG_take)
    bpy.utils.register_class(SPARSEMOCAP_PG_training)
    bpy.utils.register_class(SPARSEMOCAP_PG_teaching)
    bpy.utils.register_class(SPARSEMOCAP_PG_settings)
    Scene.sparse_mocap = PointerProperty(type=SPARSEMOCAP_PG_settings)


def unregister() -> None:
    """Unregister the settings."""
    del Scene.sparse_mocap
    bpy.utils.unregister_class(SPARSEMOCAP_PG_settings)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_teaching)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_training)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_take)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_option)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_port)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_source)
