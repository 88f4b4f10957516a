# SPDX-License-Identifier: GPL-3.0-or-later
"""One phone in Blender: choose clips, train, load a recording or stream, put it on any rig."""

from __future__ import annotations

import csv
import os
import shutil
import socket
import threading
import time
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import bpy
import numpy as np
import rigs
from live_support import own_runtime, serial_folder, until
from support import Skipped, addon, error_of, library, reconstruct, settings

SITE = "left_ankle"


@cache
def _walks() -> tuple[Path, object]:
    """A database of a walk and a jog, and a phone's readings of another walk."""
    import sparse_mocap

    folder = library().database.parent
    motions = folder / "gaits"
    motions.mkdir()
    for name in ("ada_walk_01.bvh", "ada_jog_01.bvh"):
        shutil.copy(folder / "all" / name, motions)
    database = folder / "gaits.smdb"
    sparse_mocap.build_database([motions], database)
    motion = sparse_mocap.read_motion(folder / "all" / "ada_walk_02.bvh")[0]
    standard, _ = sparse_mocap.standard_motion(motion)
    return database, sparse_mocap.simulated(standard, [SITE], 100.0).sensors[SITE]


def _chosen(classes: str = "walk") -> None:
    """The method of one phone, on the database."""
    settings().method = "eom2014"
    settings().database = str(_walks()[0])
    option = settings().options.add()
    option.name, option.value = "iterations", "40"
    settings().training.classes = classes
    settings().training.phone_site = SITE


def _train(tmp_path: Path, name: str = "model") -> str:
    path = str(tmp_path / name)
    assert bpy.ops.sparse_mocap.train_model(filepath=path) == {"FINISHED"}
    return settings().training.model


def _phone_export(folder: Path) -> Path:
    """An iPhone's export by Sensor Logger: g, of the opposite sign, columns from z to x."""
    record = _walks()[1]
    files = {
        "TotalAcceleration.csv": -record.specific_force / 9.80665,
        "Gyroscope.csv": record.angular_velocity,
    }
    path = folder / "phone.zip"
    with zipfile.ZipFile(path, "w") as packed:
        for name, values in files.items():
            rows = [["time", "seconds_elapsed", "z", "y", "x"]]
            rows += [
                [int(1e9 * t), t, *reversed(row)]
                for t, row in zip(record.times_s, values.tolist(), strict=True)
            ]
            with (folder / name).open("w", newline="") as file:
                csv.writer(file).writerows(rows)
            packed.write(folder / name, name)
        packed.writestr("Metadata.csv", "version,platform,standardisation\n3,ios,false\n")
    return path


def test_from_clips_of_the_database_to_a_character(tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    _chosen("walk, jog")
    model = _train(tmp_path)
    assert model == str(tmp_path / "model.smmodel")
    views = addon("scene.latent_view").views(bpy.context)
    assert sorted(view.name for view in views) == ["jog", "walk"]

    assert bpy.ops.sparse_mocap.import_phone(filepath=str(_phone_export(tmp_path))) == {"FINISHED"}
    assert settings().take.startswith("//takes")
    settings().target = rigs.named_rig("mixamo")
    armature = reconstruct(offline=True)
    assert armature == settings().target
    action = armature.animation_data.action
    assert action.frame_range[1] - action.frame_range[0] > 20
    thigh = next(b.name for b in armature.data.bones if "LeftUpLeg" in b.name)
    curves = addon("scene.compat").curves_of(action)
    assert any(f'"{thigh}"' in curve.data_path for curve in curves)

    bpy.context.scene.frame_set(int(sum(action.frame_range) / 2))
    motion_type, place = addon("scene.latent_view").place_now(bpy.context)
    assert views[motion_type].name == "walk"
    assert np.abs(place - 0.5).max() < 0.7


def test_the_latent_space_is_switched_on_and_off(tmp_path):
    view = addon("scene.latent_view")
    _chosen()
    assert error_of(bpy.ops.sparse_mocap.toggle_latent_view) == "Train or open a model first"
    _train(tmp_path)
    assert bpy.ops.sparse_mocap.toggle_latent_view() == {"FINISHED"}
    assert view.is_shown()
    assert bpy.ops.sparse_mocap.toggle_latent_view() == {"FINISHED"}
    assert not view.is_shown()


def test_phases_are_written_changed_and_trained_from(tmp_path):
    _chosen()
    settings().training.output = str(tmp_path / "walk")
    assert bpy.ops.sparse_mocap.write_phases() == {"FINISHED"}
    path = Path(settings().training.phases)
    header, first, *_ = path.read_text().splitlines()
    assert header == "clip,begin_s,phase"
    clip = first.split(",")[0]
    path.write_text(f"{header}\n{clip},0,standing\n{clip},0.5,jump\n")
    _train(tmp_path)
    [view] = addon("scene.latent_view").views(bpy.context)
    assert set(view.phases.tolist()) == {0, 3}
    path.write_text(f"{header}\n{clip},0,hop\n")
    assert "one named 'hop'" in error_of(bpy.ops.sparse_mocap.train_model)


def test_what_cannot_be_trained_or_used_is_said_in_a_line(tmp_path):
    settings().method = "eom2014"
    train, load = bpy.ops.sparse_mocap.train_model, bpy.ops.sparse_mocap.import_phone
    assert "motion database" in error_of(lambda: train(filepath=str(tmp_path / "x")))
    settings().database = str(library().database)
    settings().training.classes = "swim"
    assert "no clip of the class 'swim'" in error_of(lambda: train(filepath=str(tmp_path / "x")))
    nowhere = str(tmp_path / "nowhere" / "x")
    settings().training.classes = ""
    assert "does not exist" in error_of(lambda: train(filepath=nowhere))
    assert "has no steps" in error_of(lambda: train(filepath=str(tmp_path / "x")))
    assert "trained model" in error_of(bpy.ops.sparse_mocap.reconstruct) or settings().take == ""
    broken = tmp_path / "broken.smmodel"
    broken.write_bytes(b"no model")
    assert error_of(lambda: bpy.ops.sparse_mocap.open_model(filepath=str(broken)))
    assert error_of(lambda: load(filepath=str(broken)))
    assert list(tmp_path.iterdir()) == [broken]


def test_the_classes_of_the_database_are_offered():
    _chosen("")
    addon("session.database").databases.get(settings().database)
    assert addon("session.training").classes_in(settings().database) == ["jog", "walk"]
    offered = addon("scene.training")._classes(settings().training, bpy.context, "jog, w")
    assert offered == ["jog, walk"]


@contextmanager
def _sent(port: int) -> Iterator[None]:
    """A phone that sends its walk again and again, at uneven times, a line for each sample."""
    record, over = _walks()[1], threading.Event()
    random = np.random.default_rng(3)

    def send() -> None:
        begin = time.perf_counter()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not over.is_set():
                now = time.perf_counter() - begin
                row = int(100.0 * now) % len(record.times_s)
                values = [*record.specific_force[row], *record.angular_velocity[row]]
                line = ",".join(f"{value:.6g}" for value in (now, *values)) + "\n"
                sender.sendto(line.encode(), ("127.0.0.1", port))
                time.sleep(random.uniform(0.005, 0.02))

    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def _free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def test_a_phone_that_streams_moves_a_character_live(tmp_path):
    if os.name == "nt":
        raise Skipped("Blender must allow the network there")
    serial_folder()
    (tmp_path / "runtime").mkdir(mode=0o700)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    _chosen()
    _train(tmp_path)
    assert bpy.ops.sparse_mocap.use_phone_stream() == {"FINISHED"}
    assert settings().port == "udp://0.0.0.0:5005"
    port = _free_port()
    settings().port = f"udp://127.0.0.1:{port}"
    settings().target = rigs.named_rig("mixamo")
    with own_runtime(tmp_path / "runtime"), _sent(port):
        assert bpy.ops.sparse_mocap.connect_sensors() == {"FINISHED"}
        session = addon("session.live").current()
        try:
            until(lambda: session.state.error or len(session.state.sensors) == 1)
            assert session.state.error == ""
            assert bpy.ops.sparse_mocap.go_live() == {"FINISHED"}
            armature, scene = addon("scene.live").followed(), addon("scene.live")
            assert armature == settings().target
            shown = []
            until(lambda: shown.append(scene.tick()) or sum(p is not None for p in shown) >= 20)
            assert scene.latent_now() is not None
            assert addon("scene.latent_view").place_now(bpy.context) is not None
            assert session.state.warning == ""
        finally:
            session.close()
