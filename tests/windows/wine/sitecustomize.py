# SPDX-License-Identifier: GPL-3.0-or-later
"""Read by each CPython under Wine at its start: what Wine 8 lacks and every Windows has."""

import ctypes
import sys
from contextlib import suppress

# CPython 3.13 asks WMI for the version of Windows, which ends the process there.
sys.modules["_wmi"] = None

_of_library = ctypes.CDLL.__getattr__


def _function(library: ctypes.CDLL, name: str):
    """pyserial's list of ports asks for this one when it is imported."""
    if name == "CM_MapCrToWin32Err":
        return lambda result, default: default
    return _of_library(library, name)


ctypes.CDLL.__getattr__ = _function


def _let_reads_time_out(win32) -> None:
    """A read of a port ends without data after its timeout; Wine calls that an error."""
    result = win32.GetOverlappedResult

    def without_timeout(*arguments) -> bool:
        return bool(result(*arguments)) or win32.GetLastError() == _ERROR_TIMEOUT

    win32.GetOverlappedResult = without_timeout


class _WithoutSciPy:
    """SciPy for CPython 3.13 calls a function that is not there: tests that use it are skipped."""

    def find_spec(self, name: str, *_: object) -> None:
        if name == "scipy" and "pytest" in sys.modules:
            skip = sys.modules["pytest"].skip
            skip("SciPy for CPython 3.13 does not load under Wine", allow_module_level=True)


if sys.version_info >= (3, 13):
    sys.meta_path.insert(0, _WithoutSciPy())

_ERROR_TIMEOUT = 1460
with suppress(ImportError):
    from serial import win32

    _let_reads_time_out(win32)
