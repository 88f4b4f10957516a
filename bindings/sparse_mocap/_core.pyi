# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core. Shapes: T frames, J joints, S sensors. SI units, quaternions w x y z.

Long calls release the GIL. ``progress(done, total, what)`` is called with the GIL held and cancels
the call by returning False (the call then raises Cancelled and leaves nothing behind).
"""

from ._core_body import *
from ._core_calibration import *
from ._core_database import *
from ._core_model import *
from ._core_motion import *
from ._core_readings import *
from ._core_reconstruction import *
from ._core_retargeting import *
from ._core_sensors import *
from ._core_streams import *

__version__: str
GRAVITY_MPS2: float

class FormatError(ValueError):
    """The input is at fault; str() is one line: where, what, what to do."""

    path: str
    line: int
    column: int

class ConfigError(ValueError):
    """A setting is outside what it may be; str() names it, its value and its range."""

class MappingError(ValueError):
    """A skeleton is not recognised as a human body; str() says why."""

class Cancelled(Exception):
    """The progress callback asked to stop."""
