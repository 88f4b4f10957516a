# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told to whoever makes a release."""


class PackagingError(Exception):
    """Something must not be handed out as it is; the text says what, one fault a line."""
