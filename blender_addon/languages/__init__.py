# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts of the panels in other languages than English. No Blender here."""
