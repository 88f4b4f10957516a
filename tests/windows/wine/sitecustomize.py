# SPDX-License-Identifier: GPL-3.0-or-later
"""Read by each CPython under Wine at its start: what Wine 8 lacks and every Windows has."""

import ctypes
import sys

# CPython 3.13 asks WMI for the version of Windows, which ends the process there.
sys.modules["_wmi"] = None

_of_library = ctypes.CDLL.__getattr__


def _function(library: ctypes.CDLL, name: str):
    """pyserial's list of ports asks for this one when it is imported."""
    if name == "CM_MapCrToWin32Err":
        return lambda result, default: default
    return _of_library(library, name)


ctypes.CDLL.__getattr__ = _function
