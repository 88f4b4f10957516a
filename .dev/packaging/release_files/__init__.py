# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the files that are handed out, from the sources and compiled modules, and checks them."""
