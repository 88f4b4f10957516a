# SPDX-License-Identifier: GPL-3.0-or-later
"""What the animator chose, kept in the scene."""

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
from bpy.types import Context, PropertyGroup, Scene

from ..session.surroundings import surroundings

PRESETS = (
    ("default", "Default", "Tuned for smooth, steady motion"),
    ("paper", "Paper", "The constants of the publication (Tautges et al. 2011)"),
)


def _ports(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [port.port for port in surroundings.view.ports if text.lower() in port.port.lower()]


def _drivers(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [driver for driver in surroundings.view.drivers if text.lower() in driver]


class SPARSEMOCAP_PG_source(PropertyGroup):
    """A further folder or file of motions."""

    path: StringProperty(name="Path", description="A folder of motion files, or one file")


class SPARSEMOCAP_PG_settings(PropertyGroup):
    """The settings of one scene."""

    database: StringProperty(
        name="Motion database", description="The motion database (.smdb) to draw poses from"
    )
    source: StringProperty(
        name="Folder",
        description="Folder with motion files: .bvh, or .asf with .amc; searched recursively",
        subtype="DIR_PATH",
    )
    more_sources: CollectionProperty(type=SPARSEMOCAP_PG_source)
    output: StringProperty(
        name="Save as",
        description="The database file to write; empty: beside the folder, under its name",
    )
    mirror: BoolProperty(
        name="Mirror",
        description="Add every motion mirrored as well: twice the motions, and no preferred side",
        default=True,
    )
    reverse: BoolProperty(name="Reverse", description="Add every motion played backwards as well")
    tempos: BoolProperty(
        name="Other tempos",
        description="Add every motion at 0.8 and 1.25 times its tempo, while the database is small",
        default=True,
    )
    rate_hz: FloatProperty(
        name="Frame rate",
        description="Frames a second of the database; takes are reconstructed at this rate",
        default=25.0,
        min=5.0,
        max=120.0,
        precision=1,
    )
    strict: BoolProperty(
        name="Stop at bad files",
        description="Build nothing if a file cannot be used; else it is left out and listed",
    )
    exclude: StringProperty(
        name="Leave out",
        description="File names to leave out, separated by commas, for example: *_02.bvh, test*",
    )
    is_build_open: BoolProperty(
        name="Build from motion files", description="Make another motion database"
    )
    take: StringProperty(name="Take", description="The recorded take (.csv) to reconstruct")
    preset: EnumProperty(name="Preset", description="How to reconstruct", items=PRESETS)
    offline: BoolProperty(
        name="Offline",
        description=(
            "Online reconstructs as a live performance would, from what was read so far. "
            "Offline looks at the whole take for every frame: closer, and slower"
        ),
    )
    start_frame: FloatProperty(
        name="Start frame",
        description="The frame on which the take begins",
        default=1.0,
        precision=0,
        step=100,
    )
    reuse_armature: BoolProperty(
        name="Reuse armature",
        description="Add the action to a Sparse Mocap armature of this scene, not to a new one",
    )
    calibration: StringProperty(
        name="Calibration",
        description=(
            "How the sensors are strapped on (.json), as Calibrate found it. Empty: worn as "
            "Tautges et al. 2011 do"
        ),
        subtype="FILE_PATH",
    )
    height_m: FloatProperty(
        name="Height (m)",
        description="How tall the performer is, in metres",
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
        name="Driver", description="What the sensors speak", search=_drivers, default="xsens_mt"
    )
    baud: IntProperty(
        name="Baud", description="Bits a second of the serial port", default=115200, min=1200
    )
    driver_options: StringProperty(
        name="Options", description="The driver's options, for example: rate_hz=100, output=mtdata"
    )
    sites: StringProperty(
        name="Worn on",
        description=(
            "Where the sensors are worn, in their order and separated by commas, for example: "
            "left_wrist, right_wrist. Empty: by their names"
        ),
    )


def settings_of(scene: Scene) -> SPARSEMOCAP_PG_settings:
    """The scene's settings."""
    return scene.sparse_mocap


def register() -> None:
    """Give scenes their settings."""
    bpy.utils.register_class(SPARSEMOCAP_PG_source)
    bpy.utils.register_class(SPARSEMOCAP_PG_settings)
    Scene.sparse_mocap = PointerProperty(type=SPARSEMOCAP_PG_settings)


def unregister() -> None:
    """Take the settings away."""
    del Scene.sparse_mocap
    bpy.utils.unregister_class(SPARSEMOCAP_PG_settings)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_source)
