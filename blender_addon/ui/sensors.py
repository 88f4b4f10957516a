# SPDX-License-Identifier: GPL-3.0-or-later
"""The ports to connect, and the table of the connected sensors: which is worn where."""

from __future__ import annotations

from typing import Any

from bpy.types import Context, UILayout

from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session.live import LiveState
from ..session.names import shown_site
from ..session.port_scanner import port_scanner
from . import text

LOW_BATTERY_PERCENT = 20.0
_STATE_ICONS = {"live": "RADIOBUT_ON", "silent": "RADIOBUT_OFF"}
_LINK_ICONS = {"streaming": "CHECKMARK", "failed": "ERROR"}
_LONGEST_IDENTITY = 24


def ports(layout: UILayout, context: Context) -> None:
    """The ports and their protocols, to choose."""
    settings = settings_of(context.scene)
    _port(layout, context, settings, -1)
    for index, more in enumerate(settings.more_ports):
        _port(layout, context, more, index)
    layout.operator("sparse_mocap.add_port", icon="ADD")
    if settings.sites:
        column = _split(layout)
        column.prop(settings, "sites", text="Locations")


def links(layout: UILayout, state: LiveState) -> None:
    """Each connected port with its protocol and state: two rows each; messages are below."""
    for link in state.links:
        row = layout.row(align=True)
        icon = _LINK_ICONS.get(str(link["state"]), "SORTTIME")
        row.label(text=_port_name(str(link["opened_as"] or link["port"])), icon=icon)
        row.label(text=str(link["driver"]), translate=False)
        layout.label(text=str(link["state"]).capitalize(), icon="BLANK1")


def table(layout: UILayout, state: LiveState) -> None:
    """Each sensor with its body part, rate and battery: three rows each."""
    box = layout.box()
    for sensor in state.sensors:
        _sensor(box, sensor)
    if not state.sensors:
        box.label(text="Waiting for data", icon="SORTTIME")
    row = layout.row()
    if state.shaking:
        shake = tr("Shake: {site}").format(site=tr(shown_site(state.shaking)))
        row.label(text=shake, icon="HAND", translate=False)
        row.operator("sparse_mocap.shake_to_find", text="", icon="X").site = "none"
    else:
        row.enabled = bool(state.sensors)
        row.operator("sparse_mocap.shake_to_find", icon="HAND")


def _sensor(layout: UILayout, sensor: dict[str, Any]) -> None:
    column = layout.column(align=True)
    split = column.split(factor=0.62)
    split.label(
        text=_shortened(str(sensor["identity"])), icon=_STATE_ICONS.get(sensor["state"], "ERROR")
    )
    is_silent = sensor["state"] != "live"
    split.label(text="no data" if is_silent else f"{sensor['rate_hz']:.0f} Hz")
    row = column.row(align=True)
    is_worn = bool(sensor["site"])
    site = row.operator(
        "sparse_mocap.set_site",
        text=shown_site(str(sensor["site"])) if is_worn else "Choose Location",
        icon="DOWNARROW_HLT",
    )
    site.identity = str(sensor["identity"])
    battery = sensor["battery"]
    is_low = battery is not None and battery < LOW_BATTERY_PERCENT
    line = column.row()
    line.alert = is_low
    lost = tr("{count} lost").format(count=sensor["missing"])
    if battery is not None:
        said = tr("Battery {percent} %: charge it" if is_low else "Battery {percent} %")
        lost = f"{said.format(percent=f'{battery:.0f}')}, {lost}"
    line.label(text=lost, icon="ERROR" if is_low else "BLANK1", translate=False)


def _port(layout: UILayout, context: Context, port: Any, index: int) -> None:
    box = layout.box()
    row = _split(box).row(align=True)
    row.prop(port, "port", icon="PLUGIN", text="" if index >= 0 else "Port")
    if index < 0:
        row.operator("sparse_mocap.find_sensors", text="", icon="FILE_REFRESH")
    else:
        row.operator("sparse_mocap.remove_port", text="", icon="X").index = index
    known = next((one for one in port_scanner.result.ports if one.port == port.port), None)
    if known is not None and known.description:
        text.paragraph(box, context, known.description)
    column = _split(box)
    column.prop(port, "driver", text="Protocol")  # the names are too long for a narrow sidebar
    column.prop(port, "baud")
    row = column.row(align=True)
    row.prop(port, "driver_options")
    row.operator("sparse_mocap.driver_help", text="", icon="QUESTION").driver = port.driver


def _split(layout: UILayout) -> UILayout:
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def _port_name(port: str) -> str:
    return port.removeprefix("/dev/")


def _shortened(identity: str) -> str:
    """Its end tells devices of one kind apart."""
    if len(identity) <= _LONGEST_IDENTITY:
        return identity
    return "..." + identity[3 - _LONGEST_IDENTITY :]
