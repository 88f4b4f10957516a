# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's logic without Blender: jobs, files, live sessions, reconstructions."""
