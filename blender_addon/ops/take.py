# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 2: choose a recorded take."""

from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Operator

from ..scene.settings import settings_of
from ..scene.takes import add_take, find_takes, remove_take
from ..session.new_files import takes_folder
from ..session.take import SUFFIX, takes
from .now_operator import FileOperator, NowOperator


class SPARSEMOCAP_OT_load_take(FileOperator, Operator):
    """Load a recorded take (.csv)."""

    bl_idname = "sparse_mocap.load_take"
    bl_label = "Load Take"
    bl_description = "Load a recorded take (.csv)"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Read the file; remember its path if it is a take."""
        take = takes.get(bpy.path.abspath(self.filepath))
        add_take(context.scene, self.filepath, take)
        return f"Loaded a take of {len(take.sensors)} sensors, {take.duration_s:.1f} s"


class SPARSEMOCAP_OT_find_takes(NowOperator, Operator):
    """Add the takes in the folder of takes, and find missing ones there."""

    bl_idname = "sparse_mocap.find_takes"
    bl_label = "Find Takes"
    bl_description = "List all takes in the folder of takes, and find missing ones there"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(name="Folder", subtype="DIR_PATH", options={"SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Look into the folder."""
        folder = takes_folder(bpy.data.filepath, settings_of(context.scene).folder)
        if self.directory:
            folder = Path(bpy.path.abspath(self.directory))
        added = find_takes(context.scene, folder)
        return f"{added} more takes in {folder}"


class SPARSEMOCAP_OT_remove_take(NowOperator, Operator):
    """Remove the take from the list; its file stays."""

    bl_idname = "sparse_mocap.remove_take"
    bl_label = "Remove Take"
    bl_description = "Remove the take from the list. Its file stays"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only with a take in the list."""
        settings = settings_of(context.scene)
        return 0 <= settings.take_index < len(settings.takes)

    def act(self, context: Context) -> str:
        """Remove its row."""
        return f'"{remove_take(context.scene)}" is not listed any more'


CLASSES = (SPARSEMOCAP_OT_load_take, SPARSEMOCAP_OT_find_takes, SPARSEMOCAP_OT_remove_take)
