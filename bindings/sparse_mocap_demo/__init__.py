# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything the demonstration needs, made by the project itself."""
