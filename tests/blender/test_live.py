# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors in Blender. Timers do not run in background: the tests tick themselves."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path

import bpy
import installed
import numpy as np
from connected import connected
from live_support import emulated, own_runtime, serial_folder, until
from processes import is_alive
from support import (
    Skipped,
    addon,
    bones_of,
    error_of,
    in_blenders_axes,
    library,
    reconstruct,
    settings,
    undo,
)


def _ticked(num_poses: int) -> list[tuple[object, float]]:
    """The poses that were shown, and how long after the sensors read them."""
    scene, shown = addon("scene.live"), []

    def has_enough() -> bool:
        pose = scene.tick()
        if pose is not None:
            shown.append((pose, time.perf_counter() - pose.time_s))
        return len(shown) >= num_poses

    until(has_enough)
    return shown


def _points(armature) -> np.ndarray:
    bpy.context.view_layer.update()
    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    bones = evaluated.pose.bones
    names = [bone.name for bone in armature.data.bones]
    heads = [bones[name].head for name in names]
    return np.array([evaluated.matrix_world @ head for head in heads])


def _go_live():
    assert bpy.ops.sparse_mocap.go_live() == {"FINISHED"}
    return addon("scene.live").followed()


def _captures() -> list:
    from sparse_mocap.capture import CaptureClient

    return CaptureClient.running()


def test_the_armature_moves_and_nothing_else(tmp_path):
    with connected(tmp_path):
        frame = bpy.context.scene.frame_current
        armature = _go_live()
        shown = _ticked(20)
        first = _points(armature)
        shown += _ticked(30)
        assert np.abs(_points(armature) - first).max() > 0.05
        assert armature.animation_data is None or armature.animation_data.action is None
        assert bpy.context.scene.frame_current == frame
        late = np.array([seconds for _, seconds in shown])
        p50, p99 = 1e3 * np.quantile(late, [0.5, 0.99])
        print(f"sensor to shown pose: p50 {p50:.0f} ms, p99 {p99:.0f} ms, {len(late)} poses")
        assert p50 > 0.0


def test_a_network_is_used_only_if_blender_may():
    """Blender 4.2 and later; factory settings allow none."""
    settings().port = "udp://0.0.0.0:6969"
    if getattr(bpy.app, "online_access", True):
        raise Skipped("this Blender may use the network")
    said = error_of(bpy.ops.sparse_mocap.connect_sensors)
    assert "turn on Allow Online Access in Preferences > System" in said
    assert addon("session.live").current() is None
    on_network = addon("scene.online").is_on_network
    assert [on_network(port) for port in ("socket://10.0.0.2:80", "udp://[::]:6969")] == [True] * 2
    for port in ("/dev/ttyUSB0", "COM3", "udp://127.0.0.1:6969", "udp://[::1]:9", "udp://[", ""):
        assert not on_network(port), port


def test_the_shown_pose_is_the_cores(tmp_path):
    """Forward kinematics of the core is the oracle."""
    import sparse_mocap

    with connected(tmp_path):
        armature = _go_live()
        pose = _ticked(25)[-1][0]
        standard = sparse_mocap.MotionDatabase(library().database).skeleton
        skeleton = sparse_mocap.with_extremities(standard)
        motion = sparse_mocap.Motion(skeleton, 0.04, pose.root_position[None], pose.rotations[None])
        wanted = in_blenders_axes(motion.joint_positions("world"))[0]
        bpy.context.view_layer.update()
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        bones = [evaluated.pose.bones[name] for name in bones_of(armature, skeleton.names)]
        ends = np.array([bones[0].head, *(bone.tail for bone in bones[1:])])
        have_length = np.linalg.norm(skeleton.bones, axis=1) > 0.001
        have_length[0] = True
        assert np.abs(ends - wanted)[have_length].max() < 1e-4


def test_a_recording_is_baked_beside_the_file_in_one_undo_step(tmp_path):
    if not bpy.app.binary_path:
        # BPY_context_member_get reads a freed dictionary when the operator's undo step is pushed.
        raise Skipped("as a module Blender may crash when operators call others in an override")
    with connected(tmp_path) as session:
        live_armature = _go_live()
        name = live_armature.name
        assert bpy.ops.sparse_mocap.record_take() == {"FINISHED"}
        until(lambda: session.state.recording and session.state.recording["samples"] > 800)
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.ed.undo_push(message="before")
            done = bpy.ops.sparse_mocap.stop_take("EXEC_DEFAULT", True)
        assert done == {"FINISHED"}
        action = bpy.data.objects[name].animation_data.action
        assert action is not None
        assert settings().take.startswith("//takes")
        assert len(bpy.data.armatures) == 1
        assert not session.is_live_wanted
        undo()
        assert not bpy.data.actions
        assert name in bpy.data.objects


def test_an_action_is_taken_off_and_kept(tmp_path):
    settings().database, settings().take = str(library().database), str(library().take)
    before = reconstruct()
    action = before.animation_data.action.name
    with connected(tmp_path):
        assert _go_live().name == before.name
        assert bpy.data.objects[before.name].animation_data.action is None
        assert bpy.data.actions[action].use_fake_user


def test_undo_and_deletion_end_live_without_harm(tmp_path):
    with connected(tmp_path) as session:
        name = _go_live().name
        _ticked(3)
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.ed.undo_push(message="one")
            bpy.ops.ed.undo_push(message="two")
        undo()
        assert bpy.data.objects.get(name) is not None
        _ticked(3)
        bpy.data.objects.remove(bpy.data.objects[name])
        assert addon("scene.live").tick() is None
        assert not session.is_live_wanted
        assert session.is_running
        assert "gone" in addon("scene.live").ended_because()


def test_rendering_and_edit_mode_are_left_alone(tmp_path):
    with connected(tmp_path) as session:
        armature = _go_live()
        _ticked(3)
        scene, compat = addon("scene.live"), addon("scene.compat")
        is_rendering = compat.is_rendering
        compat.is_rendering = lambda: True
        try:
            before = _points(armature)
            until(lambda: session.state.num_dropped > 3)
            assert scene.tick() is None
            assert np.array_equal(_points(armature), before)
        finally:
            compat.is_rendering = is_rendering
        bpy.ops.object.mode_set(mode="EDIT")
        assert scene.tick() is None
        bpy.ops.object.mode_set(mode="OBJECT")
        _ticked(3)
        assert session.is_live_wanted


def test_another_file_ends_the_session_and_its_capture(tmp_path):
    with connected(tmp_path) as session:
        _go_live()
        [capture] = _captures()
        bpy.ops.wm.read_homefile(use_empty=True)
        assert not session.is_running
        assert addon("session.live").current() is None
        until(lambda: not is_alive(capture.pid))


def test_unregister_leaves_no_capture(tmp_path):
    with connected(tmp_path) as session:
        [capture] = _captures()
        installed.unregister()
        assert not session.is_running
        until(lambda: not is_alive(capture.pid))
        assert _captures() == []


def test_unregister_leaves_a_recording_which_is_found_again(tmp_path):
    with connected(tmp_path):
        bpy.ops.sparse_mocap.record_take()
        [capture] = _captures()
        installed.unregister()
        time.sleep(3.0)  # longer than a capture lingers
        assert is_alive(capture.pid)
        installed.register()
        scanner = addon("session.port_scanner").port_scanner
        scanner.latest()
        scanner.wait(10)
        assert scanner.result.captures[0].recording_s > 0.0
        assert bpy.ops.sparse_mocap.attach_sensors(pid=capture.pid) == {"FINISHED"}
        session = addon("session.live").current()
        until(lambda: session.state.recording is not None)
        assert bpy.ops.sparse_mocap.stop_take() == {"FINISHED"}
        bpy.ops.sparse_mocap.disconnect_sensors()
        until(lambda: not is_alive(capture.pid))


def test_disconnecting_leaves_a_capture_that_others_need(tmp_path):
    from sparse_mocap.capture import CaptureClient

    with connected(tmp_path):
        [capture] = _captures()
        other = CaptureClient(capture)
        session = addon("session.live").current()
        assert bpy.ops.sparse_mocap.disconnect_sensors() == {"FINISHED"}
        assert addon("session.live").current() is None
        until(lambda: not session.is_running)
        other.skip()
        until(lambda: len(other.read()) > 0)
        other.leave()  # it ends a little later if the list of ports is just looking at it
        until(lambda: not is_alive(capture.pid))


def test_quitting_or_crashing_leaves_no_capture(tmp_path):
    """A Blender that connects and ends, in one way or the other."""
    if not bpy.app.binary_path:
        raise Skipped("a bpy module is no Blender")
    (tmp_path / "runtime").mkdir(mode=0o700)
    script = Path(__file__).parent / "live_quit_script.py"
    import sparse_mocap

    for how in ("quit", "crash"):
        with (
            own_runtime(tmp_path / "runtime"),
            emulated(sparse_mocap.read_take(library().take)) as port,
        ):
            command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1"]
            arguments = [how, port, str(tmp_path / how), str(serial_folder())]
            done = subprocess.run(
                [*command, "--python", str(script), "--", *arguments],
                capture_output=True, text=True, timeout=60,
            )  # fmt: skip
            assert "connected" in done.stdout, done.stdout + done.stderr
            assert (done.returncode == 0) == (how == "quit"), done.stdout + done.stderr
            pid = int(done.stdout.split("connected ")[1].split()[0])
            until(lambda pid=pid: not is_alive(pid))
            assert _captures() == []


def test_nothing_connected_is_said_in_one_line():
    serial_folder()
    for operator in ("record_take", "go_live", "stop_take", "leave_live"):
        assert "Connect" in error_of(getattr(bpy.ops.sparse_mocap, operator))
    assert "port" in error_of(bpy.ops.sparse_mocap.connect_sensors)
