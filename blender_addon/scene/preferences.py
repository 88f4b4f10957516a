# SPDX-License-Identifier: GPL-3.0-or-later
"""What belongs to the person and the machine, not to a scene: kept in Blender's preferences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
from bpy.props import FloatProperty, IntProperty, StringProperty
from bpy.types import AddonPreferences, Context, PropertyGroup

from ..session.port_scanner import port_scanner

ADDON = __package__.rpartition(".")[0]


@dataclass(frozen=True)
class _Personal:
    """A property: its kind, default and what else its definition says."""

    kind: Any
    default: Any
    options: dict[str, Any]


def _ports(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [port.port for port in port_scanner.result.ports if text.lower() in port.port.lower()]


def _drivers(_: PropertyGroup, __: Context, text: str) -> list[str]:
    return [driver for driver in port_scanner.result.drivers if text.lower() in driver]


_PERSONAL: dict[str, _Personal] = {
    "database": _Personal(
        StringProperty,
        "",
        {
            "name": "Motion database",
            "description": "The motion database (.smdb) to reconstruct from",
        },
    ),
    "folder": _Personal(
        StringProperty,
        "",
        {
            "name": "Folder of takes",
            "description": (
                "Where takes are saved while the .blend file is not. "
                "Empty: Sparse Mocap in the home folder"
            ),
            "subtype": "DIR_PATH",
        },
    ),
    "calibration": _Personal(
        StringProperty,
        "",
        {
            "name": "Calibration",
            "description": (
                "Calibration of the sensors (.json), made with Calibrate. Empty: the sensors are "
                "worn in the default orientation (see README)"
            ),
            "subtype": "FILE_PATH",
        },
    ),
    "height_m": _Personal(
        FloatProperty,
        1.75,
        {
            "name": "Height (m)",
            "description": "Body height of the performer, in metres",
            "min": 0.5,
            "max": 2.5,
        },
    ),
    "port": _Personal(
        StringProperty,
        "",
        {
            "name": "Port",
            "description": "The serial port of the sensors, or udp://HOST:PORT",
            "search": _ports,
            "search_options": {"SUGGESTION"},
        },
    ),
    "driver": _Personal(
        StringProperty,
        "xsens_mt",
        {
            "name": "Sensor protocol",
            "description": "Which kind of sensors is connected",
            "search": _drivers,
        },
    ),
    "baud": _Personal(
        IntProperty,
        115200,
        {
            "name": "Baud rate",
            "description": ("Speed of the serial port, in bits per second. 0 tries the usual ones"),
            "min": 0,
        },
    ),
    "driver_options": _Personal(
        StringProperty,
        "",
        {
            "name": "Options",
            "description": (
                "Options of the protocol as name=value, separated by commas, for example: "
                "rate_hz=100, output=mtdata. `sparse-mocap drivers` lists them all"
            ),
        },
    ),
    "sites": _Personal(
        StringProperty,
        "",
        {
            "name": "Sensor locations",
            "description": (
                "Where each sensor is worn, in the order of the sensors and separated by commas, "
                "for example: left_wrist, right_wrist. The table of the connected sensors is surer"
            ),
        },
    ),
}

_PATHS = ("database", "folder", "calibration")

_without_addon: dict[str, Any] = {}
"""The values where the add-on is registered by a script, not enabled in the preferences."""


class SPARSEMOCAP_preferences(AddonPreferences):
    """The values, and their form in Blender's preferences."""

    bl_idname = ADDON

    def draw(self, context: Context) -> None:
        """All of them."""
        column = self.layout.column()
        column.use_property_split = True
        for name in _PERSONAL:
            column.prop(self, name)


SPARSEMOCAP_preferences.__annotations__ = {
    name: personal.kind(default=personal.default, **personal.options)
    for name, personal in _PERSONAL.items()
}


def own_property(name: str) -> Any:
    """A property of the same kind, for what a scene has several of."""
    personal = _PERSONAL[name]
    return personal.kind(default=personal.default, **personal.options)


def delegating(name: str) -> Any:
    """A property for the scene's settings that reads and writes the preferences."""
    personal = _PERSONAL[name]

    def value_of(_: PropertyGroup) -> Any:
        kept = _kept()
        if kept is None:
            return _without_addon.get(name, personal.default)
        return getattr(kept, name)

    def set_value(_: PropertyGroup, value: Any) -> None:
        if name in _PATHS and value.startswith("//"):
            value = bpy.path.abspath(value)  # the next file is elsewhere
        kept = _kept()
        if kept is None:
            _without_addon[name] = value
        else:
            setattr(kept, name, value)
            bpy.context.preferences.is_dirty = True  # saved when Blender quits

    return personal.kind(get=value_of, set=set_value, **personal.options)


PERSONAL = tuple(_PERSONAL)


def _kept() -> Any:
    addon = bpy.context.preferences.addons.get(ADDON)
    return addon.preferences if addon is not None else None


def register() -> None:
    """Register the preferences."""
    bpy.utils.register_class(SPARSEMOCAP_preferences)


def unregister() -> None:
    """Unregister the preferences."""
    bpy.utils.unregister_class(SPARSEMOCAP_preferences)
