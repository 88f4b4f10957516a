# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sensor is worn where, and which ports sensors are at."""

from __future__ import annotations

from typing import Any

from bpy.props import IntProperty, StringProperty
from bpy.types import Context, Event, Operator

from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session.core import core
from ..session.errors import InputError
from ..session.live import answer_of
from ..session.names import shown_site
from ..session.port_scanner import port_scanner
from .live import ANSWER_S, connected
from .now_operator import NowOperator

NOWHERE = "none"
"""The site of a sensor that is not used."""


class SPARSEMOCAP_OT_set_site(NowOperator, Operator):
    """Choose where this sensor is worn."""

    bl_idname = "sparse_mocap.set_site"
    bl_label = "Sensor Location"
    bl_description = (
        "Choose where this sensor is worn. It is remembered for this sensor, whatever its port"
    )
    bl_options = {"REGISTER"}

    identity: StringProperty(name="Sensor", options={"SKIP_SAVE"})
    site: StringProperty(name="Sensor location", options={"SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Show the body parts as a menu."""
        identity = self.identity

        def draw(menu: Any, _: Context) -> None:
            for site in (*core().site_names(), NOWHERE):
                choice = menu.layout.operator("sparse_mocap.set_site", text=shown_site(site))
                choice.identity, choice.site = identity, site

        if self.site:
            return self.execute(context)
        title = tr("Where is {sensor} worn?").format(sensor=identity)
        context.window_manager.popup_menu(draw, title=title)
        return {"FINISHED"}

    def act(self, context: Context) -> str:
        """Tell the session."""
        site = "" if self.site == NOWHERE else self.site
        if site and site not in core().site_names():
            raise InputError(f'Unknown sensor location "{site}": choose one from the menu')
        answer_of(connected().set_site(self.identity, site), ANSWER_S)
        return ""


class SPARSEMOCAP_OT_shake_to_find(NowOperator, Operator):
    """Find a sensor by shaking it."""

    bl_idname = "sparse_mocap.shake_to_find"
    bl_label = "Shake to Find"
    bl_description = "Choose a body part, then shake the sensor that is worn there"
    bl_options = {"REGISTER"}

    site: StringProperty(name="Sensor location", options={"SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Show the body parts as a menu."""

        def draw(menu: Any, _: Context) -> None:
            for site in core().site_names():
                menu.layout.operator(
                    "sparse_mocap.shake_to_find", text=shown_site(site)
                ).site = site

        if self.site:
            return self.execute(context)
        context.window_manager.popup_menu(draw, title=tr("Which sensor will be shaken?"))
        return {"FINISHED"}

    def act(self, context: Context) -> str:
        """Start looking, or stop if it is running."""
        site = "" if self.site == NOWHERE else self.site
        answer_of(connected().find_by_shaking(site), ANSWER_S)
        return ""


class SPARSEMOCAP_OT_driver_help(NowOperator, Operator):
    """The options of a sensor protocol; the tooltip shows them."""

    bl_idname = "sparse_mocap.driver_help"
    bl_label = "Options of the Protocol"
    bl_options = {"INTERNAL"}

    driver: StringProperty(name="Sensor protocol", options={"SKIP_SAVE"})

    @classmethod
    def description(cls, context: Context, properties: Any) -> str:
        """What the protocol is for, and its options."""
        known = port_scanner.result.driver_help
        return known.get(properties.driver, "Choose a protocol: its options are listed here")

    def act(self, context: Context) -> str:
        """Show them as a message too."""
        known = port_scanner.result.driver_help
        return known.get(self.driver, "Choose a protocol first")


class SPARSEMOCAP_OT_add_port(NowOperator, Operator):
    """Add a port, for sensors that have one each."""

    bl_idname = "sparse_mocap.add_port"
    bl_label = "Add Port"
    bl_description = "Add a port, for sensors that have one each"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """The new port has the settings of the one before."""
        settings = settings_of(context.scene)
        before = settings.more_ports[-1] if settings.more_ports else settings
        driver, baud, options = before.driver, before.baud, before.driver_options
        added = settings.more_ports.add()
        added.driver, added.baud, added.driver_options = driver, baud, options
        return ""


class SPARSEMOCAP_OT_remove_port(NowOperator, Operator):
    """Remove this port."""

    bl_idname = "sparse_mocap.remove_port"
    bl_label = "Remove Port"
    bl_description = "Remove this port from the list"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(name="Number", options={"SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Remove it from the scene's list."""
        settings_of(context.scene).more_ports.remove(self.index)
        return ""


CLASSES = (
    SPARSEMOCAP_OT_set_site,
    SPARSEMOCAP_OT_shake_to_find,
    SPARSEMOCAP_OT_driver_help,
    SPARSEMOCAP_OT_add_port,
    SPARSEMOCAP_OT_remove_port,
)
