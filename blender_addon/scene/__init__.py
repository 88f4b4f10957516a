# SPDX-License-Identifier: GPL-3.0-or-later
"""All access to Blender's data, and every difference between Blender versions."""


def register() -> None:
    """Register the settings."""
    from . import clips, mapping, preferences, settings, translations

    translations.register()
    preferences.register()
    settings.register()
    clips.register()
    mapping.register()


def unregister() -> None:
    """Unregister the settings."""
    from . import clips, mapping, preferences, settings, translations

    mapping.unregister()
    clips.unregister()
    settings.unregister()
    preferences.unregister()
    translations.unregister()
