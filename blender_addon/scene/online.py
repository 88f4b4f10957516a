# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's switch for the network, which extensions must obey."""

from __future__ import annotations

from urllib.parse import urlsplit

import bpy

from ..session.errors import InputError

_THIS_MACHINE = ("localhost", "127.0.0.1", "::1")


def check_online_access(port: str) -> None:
    """Raises InputError if the port is on a network and Blender may not use networks."""
    if not is_on_network(port) or getattr(bpy.app, "online_access", True):
        return
    raise InputError(
        "Sensors on a network need Blender's permission: turn on Allow Online Access in "
        "Preferences > System, and connect again"
    )


def is_on_network(port: str) -> bool:
    """Whether the port is a URL that leads to another machine or listens for others."""
    try:
        host = urlsplit(port).hostname if "://" in port else None
    except ValueError:
        return False  # whoever opens the port says what is wrong with it
    return host is not None and host not in _THIS_MACHINE
