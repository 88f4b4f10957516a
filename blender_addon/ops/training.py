# SPDX-License-Identifier: GPL-3.0-or-later
"""Models that learn from clips: train one, open one; recordings and streams of a phone."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Operator

from ..scene import latent_view
from ..scene.clips import clip_list, opened_database
from ..scene.settings import SPARSEMOCAP_PG_settings, options_text, settings_of
from ..scene.takes import add_take
from ..scene.translations import tr_line
from ..session.errors import InputError
from ..session.job import Job
from ..session.methods import models
from ..session.new_files import takes_folder
from ..session.phone import PHONE_DRIVER, PHONE_OPTIONS, PHONE_PORT, import_phone
from ..session.steps import Steps
from ..session.take import takes
from ..session.training import (
    SUFFIX,
    Trained,
    TrainingChoices,
    default_output,
    train_job,
    with_name,
    write_phases,
)
from .job_operator import JobOperator
from .now_operator import FileOperator, NowOperator

SKIP = {"SKIP_SAVE"}


def _choices(settings: SPARSEMOCAP_PG_settings) -> TrainingChoices:
    training = settings.training
    return TrainingChoices(
        settings.method,
        training.classes,
        training.clips,
        bpy.path.abspath(training.phases),
        options_text(settings),
    )


def _output(settings: SPARSEMOCAP_PG_settings, choices: TrainingChoices) -> str:
    given = bpy.path.abspath(settings.training.output)
    return given or default_output(bpy.path.abspath(settings.database), choices)


class SPARSEMOCAP_OT_train_model(JobOperator, Operator):
    """Learn a model from clips of the motion database."""

    bl_idname = "sparse_mocap.train_model"
    bl_label = "Train"
    bl_description = "Train a model on the chosen clips of the motion database, and use it"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="Save as", description="The .smmodel file to write", subtype="FILE_PATH", options=SKIP
    )

    def prepare(self, context: Context) -> Job:
        """Train from what the scene's settings choose."""
        settings = settings_of(context.scene)
        choices = _choices(settings)
        output = bpy.path.abspath(self.filepath) or _output(settings, choices)
        return train_job(bpy.path.abspath(settings.database), output, choices)

    def apply(self, context: Context, result: Trained) -> Steps[str]:
        """Use the new model."""
        yield 0.0
        settings_of(context.scene).training.model = result.path
        clips, types = result.num_clips, len(result.types)
        if types > 1:
            return f"Trained a model on {clips} clips of {types} types of motion"
        return f"Trained a model on {clips} clips"


class SPARSEMOCAP_OT_open_model(FileOperator, Operator):
    """Open a trained model (.smmodel)."""

    bl_idname = "sparse_mocap.open_model"
    bl_label = "Open Model"
    bl_description = "Open a trained model (.smmodel)"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Open the file; remember its path if it is a model of the method."""
        settings = settings_of(context.scene)
        model = models.get(bpy.path.abspath(self.filepath))
        if model.method != settings.method:
            raise InputError(
                f"This model is for {model.method}, not for {settings.method}: open another "
                "one, or change the method"
            )
        settings.training.model = self.filepath
        return ""


class SPARSEMOCAP_OT_add_training_clip(NowOperator, Operator):
    """Train also on the clip that is selected in the list of clips."""

    bl_idname = "sparse_mocap.add_training_clip"
    bl_label = "Add Selected Clip"
    bl_description = "Add the clip that is selected in the list of clips"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Add its name."""
        database, index = opened_database(context), clip_list(context).index
        if database is None or index >= len(database.clips.rows):
            raise InputError("Select a clip in the list of clips first")
        training = settings_of(context.scene).training
        training.clips = with_name(training.clips, database.clips.rows[index].name)
        return f"Training from: {training.clips}"


class SPARSEMOCAP_OT_write_phases(NowOperator, Operator):
    """Write where the phases of the clips begin to a file, to change them."""

    bl_idname = "sparse_mocap.write_phases"
    bl_label = "Write Phases"
    bl_description = (
        "Write to a file where the phases of the chosen clips begin. Change the times in a text "
        "editor or a spreadsheet, and train again"
    )
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Write the file beside the model, and use it."""
        settings = settings_of(context.scene)
        choices = _choices(settings)
        path, count = write_phases(
            bpy.path.abspath(settings.database), _output(settings, choices), choices
        )
        settings.training.phases = path
        return f"The phases of {count} clips are in {path}"


class SPARSEMOCAP_OT_import_phone(FileOperator, Operator):
    """Load what a phone recorded."""

    bl_idname = "sparse_mocap.import_phone"
    bl_label = "Load Phone Recording"
    bl_description = (
        "Load a recording of one phone, as phyphox and Sensor Logger export it (.zip or .csv), "
        "as a take"
    )
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.zip;*.csv", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Convert it to a take in the folder of takes, and list that."""
        settings = settings_of(context.scene)
        folder = takes_folder(bpy.data.filepath, settings.folder)
        path, notes = import_phone(
            Path(bpy.path.abspath(self.filepath)), folder, settings.training.phone_site
        )
        add_take(context.scene, path, takes.get(path))
        for note in notes:
            self.report({"INFO"}, tr_line(note))
        return f"Saved as {path}"


class SPARSEMOCAP_OT_use_phone_stream(NowOperator, Operator):
    """Set the port up for a phone that sends its sensors by UDP."""

    bl_idname = "sparse_mocap.use_phone_stream"
    bl_label = "Stream from Phone"
    bl_description = (
        "Set Live Sensors up for an app that sends a line of time, accelerometer (m/s²) and "
        "gyroscope (rad/s) for each sample to UDP port 5005 of this computer"
    )
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Fill in port, protocol and location."""
        settings = settings_of(context.scene)
        settings.port, settings.driver = PHONE_PORT, PHONE_DRIVER
        settings.driver_options = PHONE_OPTIONS
        settings.sites = settings.training.phone_site
        return "Live Sensors is set up for a phone: press Connect there"


class SPARSEMOCAP_OT_toggle_latent_view(NowOperator, Operator):
    """Show the latent space of the model, and where the motion is in it."""

    bl_idname = "sparse_mocap.toggle_latent_view"
    bl_label = "Latent Space"
    bl_description = (
        "Show in the viewport what the model knows: a point for each frame in the colour of its "
        "phase, and where the live motion is"
    )
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Switch it."""
        latent_view.toggle(context)
        return ""


CLASSES = (
    SPARSEMOCAP_OT_train_model,
    SPARSEMOCAP_OT_open_model,
    SPARSEMOCAP_OT_add_training_clip,
    SPARSEMOCAP_OT_write_phases,
    SPARSEMOCAP_OT_import_phone,
    SPARSEMOCAP_OT_use_phone_stream,
    SPARSEMOCAP_OT_toggle_latent_view,
)
