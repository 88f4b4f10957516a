# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes as strips of the NLA."""

from __future__ import annotations

import numpy as np
from bpy.types import Action, NlaStrip, Object


def push_to_nla(armature: Object, action: Action) -> NlaStrip:
    """Put the armature's action into a strip on a new track, where its keys are now."""
    data = armature.animation_data
    slot = getattr(data, "action_slot", None)
    first = action.frame_range[0]
    data.action = None
    track = data.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(np.floor(first)), action)
    if slot is not None and hasattr(strip, "action_slot"):
        strip.action_slot = next(
            (own for own in action.slots if own.identifier == slot.identifier), action.slots[0]
        )
    strip.frame_start = first
    return strip
