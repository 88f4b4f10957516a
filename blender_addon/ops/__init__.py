# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one file for each step, and one for when the add-on cannot work."""
