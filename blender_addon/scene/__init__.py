# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that makes or reads Blender's data, and every difference between its versions."""


def register() -> None:
    """Give scenes their settings."""
    from . import clips, mapping, settings

    settings.register()
    clips.register()
    mapping.register()


def unregister() -> None:
    """Take the settings away."""
    from . import clips, mapping, settings

    mapping.unregister()
    clips.unregister()
    settings.unregister()
