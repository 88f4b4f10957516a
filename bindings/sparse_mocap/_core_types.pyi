# SPDX-License-Identifier: GPL-3.0-or-later
"""Types that the parts of the compiled core share. Known to type checkers only."""

import os
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Path = str | os.PathLike[str]
ProgressCallback = Callable[[int, int, str], bool | None]
Floats = NDArray[np.float64]
