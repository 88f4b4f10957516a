# SPDX-License-Identifier: GPL-3.0-or-later
"""What the animator works with, without Blender: jobs, opened files, reconstructions."""
