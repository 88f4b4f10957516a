# SPDX-License-Identifier: GPL-3.0-or-later
"""Where each sensor is worn, remembered by the device's own identity."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

from .. import site_names
from ..files import write_text
from ..settings_folder import settings_folder

__all__ = ["remember_sites", "remembered_sites", "sites_path"]

FILE_VARIABLE = "SPARSE_MOCAP_SENSORS"
_FORMAT = "sparse_mocap_sensors"
_MOST_SENSORS = 1000


def sites_path() -> Path:
    """The file; the variable SPARSE_MOCAP_SENSORS overrides it."""
    named = os.environ.get(FILE_VARIABLE)
    return Path(named) if named else settings_folder() / "sensors.json"


def remembered_sites() -> dict[str, str]:
    """Returns the site of each known sensor by its identity; what cannot be read is forgotten."""
    try:
        whole = json.loads(sites_path().read_text(encoding="utf-8"))
        sites = whole["sites"] if whole["format"] == _FORMAT else {}
        known = site_names()
        return {str(name): site for name, site in sites.items() if site in known}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def remember_sites(sites: Mapping[str, str]) -> None:
    """Remembers sites by sensors' identities; an empty site forgets the sensor. Raises OSError."""
    known = {**remembered_sites(), **sites}
    kept = dict([(name, site) for name, site in known.items() if site][-_MOST_SENSORS:])
    path = sites_path()
    path.parent.mkdir(parents=True, exist_ok=True)
    whole = {"format": _FORMAT, "format_version": 1, "sites": kept}
    write_text(path, json.dumps(whole, indent=2, ensure_ascii=False) + "\n")
