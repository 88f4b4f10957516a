# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar panels, one file for each step, the import dialog, and what is shown instead of them.

Importing this package and ``installation`` in it needs neither NumPy nor the core.
"""
