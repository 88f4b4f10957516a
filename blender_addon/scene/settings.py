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
from ..session.port_scanner import port_scanner

_kept_items: dict[str, Items] = {}
"""Blender does not keep the texts of menus that are made on the fly; this does."""


def _kept(key: str, items: Items) -> Items:
    _kept_items[key] = items or [("default", "Default", "The default settings")]
    return _kept_items[key]


def _methods(_: PropertyGroup, __: Context) -> Items:
    return _kept("methods", method_items())


def _presets(settings: PropertyGroup, _: Context) -> Items:
    return _kept(f"presets of {settings.method}", preset_items(settings.method))


def _ports(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [port.port for port in port_scanner.result.ports if text.lower() in port.port.lower()]


def _drivers(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [driver for driver in port_scanner.result.drivers if text.lower() in driver]


def _is_armature(_: PropertyGroup, obj: Object) -> bool:
    return obj.type == "ARMATURE"


class SPARSEMOCAP_PG_source(PropertyGroup):
    """Another folder or motion file."""

    path: StringProperty(name="Path", description="A folder of motion files, or a single file")


class SPARSEMOCAP_PG_option(PropertyGroup):
    """An option of the method and the value to use instead of the default."""

    name: StringProperty(name="Option")
    value: StringProperty(name="Value", description="The value to use; press X for the default")


class SPARSEMOCAP_PG_settings(PropertyGroup):
    """The settings of one scene."""

    database: StringProperty(
        name="Motion database", description="The motion database (.smdb) to reconstruct from"
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
        name="Fastest (m/s)",
        description="A foot that is faster than this is not locked, in m/s",
        default=0.5,
        min=0.0,
        max=3.0,
    )
    highest_foot_m: FloatProperty(
        name="Highest (m)",
        description="A foot that is higher above the floor than this is not locked, in m",
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
    in_place: BoolProperty(
        name="In place", description="Keep the live character at the origin while it moves"
    )
    calibration: StringProperty(
        name="Calibration",
        description=(
            "Calibration of the sensors (.json), made with Calibrate. Empty: the sensors are worn "
            "in the default orientation (see README)"
        ),
        subtype="FILE_PATH",
    )
    height_m: FloatProperty(
        name="Height (m)",
        description="Body height of the performer, in metres",
        default=1.75,
        min=0.5,
        max=2.5,
    )
    port: StringProperty(
        name="Port",
        description="The serial port of the sensors, or udp://HOST:PORT",
        search=_ports,
        search_options={"SUGGESTION"},
    )
    driver: StringProperty(
        name="Sensor protocol",
        description="Which kind of sensors is connected",
        search=_drivers,
        default="xsens_mt",
    )
    baud: IntProperty(
        name="Baud rate",
        description="Speed of the serial port, in bits per second",
        default=115200,
        min=1200,
    )
    driver_options: StringProperty(
        name="Options",
        description="Options of the protocol, for example: rate_hz=100, output=mtdata",
    )
    sites: StringProperty(
        name="Sensor locations",
        description=(
            "Where each sensor is worn, in the order of the sensors and separated by commas, for "
            "example: left_wrist, right_wrist. Empty: the names of the sensors"
        ),
    )


def settings_of(scene: Scene) -> SPARSEMOCAP_PG_settings:
    """The scene's settings."""
    return scene.sparse_mocap


def options_text(settings: SPARSEMOCAP_PG_settings) -> str:
    """The options that differ from the method's defaults, as operators take them."""
    return written_options([(option.name, option.value) for option in settings.options])


def scene_choice(scene: Scene) -> MethodChoice:
    """The method that the scene's settings name. Raises InputError."""
    settings = settings_of(scene)
    return choice_of(settings.method, settings.preset, options_text(settings))[0]


def register() -> None:
    """Register the settings."""
    bpy.utils.register_class(SPARSEMOCAP_PG_source)
    bpy.utils.register_class(SPARSEMOCAP_PG_option)
    bpy.utils.register_class(SPARSEMOCAP_PG_settings)
    Scene.sparse_mocap = PointerProperty(type=SPARSEMOCAP_PG_settings)


def unregister() -> None:
    """Unregister the settings."""
    del Scene.sparse_mocap
    bpy.utils.unregister_class(SPARSEMOCAP_PG_settings)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_option)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_source)
