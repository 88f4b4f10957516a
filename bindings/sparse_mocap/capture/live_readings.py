# SPDX-License-Identifier: GPL-3.0-or-later
"""From samples as they arrive to readings at a database's rate, for live reconstruction."""

from ..readings import LiveReadings, push_samples

__all__ = ["LiveReadings", "push_samples"]
