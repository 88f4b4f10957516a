# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import, on small files written here; the oracle is a second reader of .bvh."""

import bpy
import bvh_oracle
import numpy as np
from support import addon, contents, error_of, in_blenders_axes, undo

FRAMES = 7
HUMAN = """HIERARCHY
ROOT mixamorig:Hips
{
  OFFSET 1.5 90 -2
  CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition Zposition
  JOINT mixamorig:Spine
  {
    OFFSET 0 0 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    JOINT say "head"\\n
    {
      OFFSET 1 40 3
      CHANNELS 6 Xposition Yposition Zposition Xrotation Zrotation Yrotation
      End Site
      {
        OFFSET 0 20 0
      }
    }
    JOINT arm
    {
      OFFSET 20 35 0
      CHANNELS 1 Zrotation
      JOINT fingers
      {
        OFFSET 25 0 0
        CHANNELS 2 Yrotation Xposition
        End Site
        {
          OFFSET 0 0 0
        }
      }
    }
  }
  JOINT leg
  {
    OFFSET 10 -5 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT toe
    {
      OFFSET 0 -0.05 0
      CHANNELS 3 Xrotation Yrotation Zrotation
      End Site
      {
        OFFSET 0 0 12
      }
    }
  }
}
MOTION
Frames: 7
Frame Time: 0.0166667
"""
ASF = """:version 1.10
:name small
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name lfemur
    direction 0.342 -0.94 0
    length 7.5
    axis 0 0 20 XYZ
    dof rx ry rz
  end
  begin
    id 2
    name ltibia
    direction 0.342 -0.94 0
    length 7.0
    axis 0 0 20 XYZ
    dof rx
  end
:hierarchy
  begin
    root lfemur
    lfemur ltibia
  end
"""


def _bvh(folder, text=HUMAN, name="walk.bvh", seed=0):
    """The file with random values in its channels."""
    random = np.random.default_rng(seed)
    width = sum(int(line.split()[1]) for line in text.split("\n") if "CHANNELS" in line)
    rows = random.uniform(-60.0, 60.0, size=(FRAMES, width))
    rows[:, 3] += np.linspace(0.0, 2000.0, FRAMES)  # turns beyond 180 degrees
    path = folder / name
    path.write_text(text + "\n".join(" ".join(f"{x:.6f}" for x in row) for row in rows) + "\n")
    return path


def _amc(folder, name="02_01.amc", num_frames=5):
    random = np.random.default_rng(3)
    text = ":FULLY-SPECIFIED\n:DEGREES\n"
    for frame in range(num_frames):
        a = random.uniform(-50.0, 50.0, size=10)
        text += f"{frame + 1}\nroot {' '.join(f'{x:.4f}' for x in a[:6])}\n"
        text += f"lfemur {a[6]:.4f} {a[7]:.4f} {a[8]:.4f}\nltibia {a[9]:.4f}\n"
    (folder / "02.asf").write_text(ASF)
    (folder / name).write_text(text)
    return folder / name


def _import_bvh(path, **options):
    assert bpy.ops.sparse_mocap.import_bvh(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def _import_acclaim(path, **options):
    assert bpy.ops.sparse_mocap.import_acclaim(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def _at(armature, frame):
    whole = int(np.floor(frame))
    bpy.context.scene.frame_set(whole, subframe=frame - whole)
    return armature.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones


def _check_bvh(path, unit_m, frames=range(FRAMES), **options):
    """All joints and End Sites of the file are where the second reader says, within 1 mm.

    frames: None for about ten of them.
    """
    nodes, rows, frame_time_s = bvh_oracle.read(path)
    frames = range(0, len(rows), max(len(rows) // 10, 1)) if frames is None else frames
    render = bpy.context.scene.render
    before = (render.fps, render.fps_base, bpy.context.scene.frame_end)
    armature = _import_bvh(path, **options)
    assert (render.fps, render.fps_base, bpy.context.scene.frame_end) == before
    for index in frames:
        time_s = index * frame_time_s
        bones = _at(armature, options.get("start_frame", 1.0) + time_s * before[0] / before[1])
        wanted = unit_m * in_blenders_axes(bvh_oracle.places(nodes, rows[index]))
        for node, point in zip(nodes, wanted, strict=True):
            if node.is_end and np.linalg.norm(node.offset) * unit_m < 1e-3:
                continue  # where a bone has no length Blender needs one
            found = bones[nodes[node.parent].name].tail if node.is_end else bones[node.name].head
            error = np.linalg.norm(np.array(found) - point)
            assert error < 1e-3, f"{node.name} is {1000 * error:.2f} mm off in frame {index}"
    return armature


def test_positions_at_24_fps(tmp_path):
    _check_bvh(_bvh(tmp_path), 0.01)


def test_positions_at_25_fps(tmp_path):
    bpy.context.scene.render.fps = 25
    _check_bvh(_bvh(tmp_path, seed=1), 0.01, start_frame=-30.5)


def test_positions_at_29_97_fps(tmp_path):
    render = bpy.context.scene.render
    render.fps, render.fps_base = 30, 1.001
    _check_bvh(_bvh(tmp_path, seed=2), 0.01, start_frame=11.0)


def test_positions_at_60_fps(tmp_path):
    bpy.context.scene.render.fps = 60
    _check_bvh(_bvh(tmp_path, seed=3), 0.01)


def test_a_unit_makes_the_figure_larger(tmp_path):
    _check_bvh(_bvh(tmp_path), 0.0254, unit="INCH")
    _check_bvh(_bvh(tmp_path), 0.001, unit="MM")


def test_keys_are_grouped_continuous_quaternions(tmp_path):
    armature = _import_bvh(_bvh(tmp_path))
    action = armature.animation_data.action
    assert action.name == armature.name == "walk"
    assert action.use_fake_user
    paths = {}
    for curve in addon("scene.compat").curves_of(action):
        assert curve.data_path.startswith('pose.bones["')
        assert armature.path_resolve(curve.data_path) is not None
        values = np.empty(2 * len(curve.keyframe_points))
        curve.keyframe_points.foreach_get("co", values)
        assert len(values) == 2 * FRAMES
        paths.setdefault(curve.data_path, {})[curve.array_index] = values[1::2]
        bone = armature.pose.bones[curve.group.name]
        assert curve.data_path.startswith(bone.path_from_id())
    moved = sorted(path for path in paths if path.endswith("location"))
    assert len(moved) == 3  # the root, and the two joints that the file moves
    turned = [path for path in paths if path.endswith("rotation_quaternion")]
    assert len(turned) == len(armature.data.bones) == 7
    for path in turned:
        values = np.column_stack([paths[path][index] for index in range(4)])
        assert (np.einsum("ij,ij->i", values[1:], values[:-1]) > 0.0).all()


def test_every_frame_on_a_frame_of_the_scene(tmp_path):
    armature = _import_bvh(_bvh(tmp_path), keep_timing=False, start_frame=10.0)
    assert tuple(armature.animation_data.action.frame_range) == (10.0, 10.0 + FRAMES - 1)


def test_z_up_stands(tmp_path):
    nodes, rows, _ = bvh_oracle.read(_bvh(tmp_path))
    bones = _at(_import_bvh(tmp_path / "walk.bvh", up_axis="Z"), 1.0)
    head = 0.01 * bvh_oracle.places(nodes, rows[0])[2]
    assert np.allclose(bones[nodes[2].name].head, head, atol=1e-3)  # Blender's own axes are z up


def test_names_that_are_too_long_or_alike(tmp_path):
    text, long = HUMAN, "b" * 70
    for old, new in (("arm", long), ("fingers", long + "c"), ("leg", "ü" * 40), ("toe", "arm")):
        text = text.replace(f"JOINT {old}\n", f"JOINT {new}\n")
    path = _bvh(tmp_path, text)
    nodes, rows, _ = bvh_oracle.read(path)
    armature = _import_bvh(path)
    bones = _at(armature, 1.0)
    assert len(bones) == 7
    wanted = 0.01 * in_blenders_axes(bvh_oracle.places(nodes, rows[0]))
    spine = next(bone for bone in bones if bone.name.endswith("Spine"))
    long_bone = next(bone for bone in spine.children if bone.name.startswith("bbb"))
    for bone, name in ((long_bone, long), (long_bone.children[0], long + "c")):
        point = next(p for n, p in zip(nodes, wanted, strict=True) if n.name == name)
        assert np.linalg.norm(np.array(bone.head) - point) < 1e-3


def test_a_second_root_is_left_out_and_said(tmp_path):
    second = "ROOT prop\n{\n OFFSET 0 0 0\n CHANNELS 1 Xrotation\n}\n"
    path = _bvh(tmp_path, HUMAN.replace("MOTION", second + "MOTION"))
    armature = _import_bvh(path)
    assert len(armature.data.bones) == 7
    imported = addon("session.imported")
    (loaded,) = imported.import_job([str(path)], (".bvh",), imported.ImportOptions()).run().motions
    assert any("ROOT" in warning for warning in loaded.warnings)


def _check_acclaim(path, rate_hz, factor=1.0, **options):
    import sparse_mocap

    motion, _ = sparse_mocap.read_motion(path)
    wanted = factor * in_blenders_axes(motion.joint_positions("world"))
    armature = _import_acclaim(path, **options)
    for index in range(0, motion.num_frames, max(motion.num_frames // 10, 1)):
        bones = _at(armature, 1.0 + index / rate_hz * 24)
        for joint, name in enumerate(motion.skeleton.names):
            at_head = np.linalg.norm(motion.skeleton.bones[joint]) * factor < 1e-3
            found = bones[name].head if at_head else bones[name].tail
            assert np.linalg.norm(np.array(found) - wanted[index, joint]) < 1e-3 * max(factor, 1.0)
    return armature


def test_acclaim_with_its_skeleton(tmp_path):
    path = _amc(tmp_path)
    armature = _check_acclaim(path, 120.0)
    assert armature.name == "02_01"
    assert [bone.name for bone in armature.data.bones] == ["root", "lfemur", "ltibia"]
    length = armature.data.bones["lfemur"].length
    assert abs(length - 7.5 * 0.0254 / 0.45) < 1e-3
    _check_acclaim(path, 60.0, amc_rate_hz=60.0)
    _check_acclaim(path, 120.0, factor=0.45 / 0.0254 * 0.1, unit="DM")


def test_acclaim_up_axis(tmp_path):
    import sparse_mocap

    motion, _ = sparse_mocap.read_motion(_amc(tmp_path))
    wanted = motion.joint_positions("world")[0]  # z up is Blender's own way
    bones = _at(_import_acclaim(tmp_path / "02_01.amc", up_axis="Z"), 1.0)
    assert np.allclose(bones["ltibia"].tail, wanted[2], atol=1e-3)
    assert np.allclose(bones["root"].head, wanted[0], atol=1e-3)


def test_a_skeleton_alone_is_an_armature_in_rest_pose(tmp_path):
    _amc(tmp_path)
    armature = _import_acclaim(tmp_path / "02.asf")
    assert armature.animation_data is None
    assert not bpy.data.actions
    assert abs(armature.data.bones["ltibia"].tail_local.z) < 1e-5  # on the ground
    assert armature.data.bones["ltibia"].parent == armature.data.bones["lfemur"]


def test_several_files_at_once(tmp_path):
    _amc(tmp_path)
    _amc(tmp_path, name="02_02.amc", num_frames=3)
    files = [{"name": name} for name in ("02_01.amc", "02.asf", "02_02.amc")]
    done = bpy.ops.sparse_mocap.import_acclaim(directory=str(tmp_path), files=files)
    assert done == {"FINISHED"}
    assert sorted(bpy.data.objects.keys()) == ["02_01", "02_02"]
    assert sorted(bpy.data.actions.keys()) == ["02_01", "02_02"]
    for name, obj in bpy.data.objects.items():
        assert obj.animation_data.action.name == name


def test_the_chosen_skeleton_is_taken(tmp_path):
    path = _amc(tmp_path, name="elsewhere.amc")
    for name in ("other", "02"):
        (tmp_path / f"{name}.asf").write_text(ASF.replace("7.5", "9.0" if name == "02" else "7.5"))
    assert ".asf" in error_of(lambda: bpy.ops.sparse_mocap.import_acclaim(filepath=str(path)))
    files = [{"name": "elsewhere.amc"}, {"name": "02.asf"}]
    bpy.ops.sparse_mocap.import_acclaim(directory=str(tmp_path), files=files)
    bones = bpy.context.view_layer.objects.active.data.bones
    assert abs(bones["lfemur"].length - 9.0 * 0.0254 / 0.45) < 1e-3


def test_onto_the_standard_skeleton():
    from support import library

    path = next(library().motions.iterdir())
    armature = _import_bvh(path, standard_skeleton=True)
    assert len(armature.data.bones) == 27  # with feet, toes and hands
    assert addon("scene.armature").is_ours(armature)


def test_one_undo_removes_everything(tmp_path):
    path = _bvh(tmp_path)
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message="before")
    before = contents()
    with bpy.context.temp_override(window=window):
        bpy.ops.sparse_mocap.import_bvh("EXEC_DEFAULT", True, filepath=str(path))
    assert len(bpy.data.armatures) == 1
    undo()
    assert contents() == before


def test_closing_halfway_leaves_nothing(tmp_path):
    mesh = bpy.data.objects.new("other", bpy.data.meshes.new("other"))
    bpy.context.scene.collection.objects.link(mesh)
    bpy.context.view_layer.objects.active = mesh
    imported = addon("session.imported")
    motions = [
        imported.load_motion(str(_bvh(tmp_path)), imported.ImportOptions()) for _ in range(2)
    ]
    before = contents()
    steps = addon("scene.imported").import_steps(bpy.context, motions, 1.0, keeps_timing=True)
    while len(bpy.data.actions) < 2:
        next(steps)
    steps.close()
    assert contents() == before


def test_what_is_wrong_is_said_in_one_line(tmp_path):
    def bvh(path):
        return error_of(lambda: bpy.ops.sparse_mocap.import_bvh(filepath=str(path)))

    def acclaim(path):
        return error_of(lambda: bpy.ops.sparse_mocap.import_acclaim(filepath=str(path)))

    assert ".bvh" in bvh("")
    assert "gone.bvh" in bvh(tmp_path / "gone.bvh")
    assert ".bvh" in bvh(_amc(tmp_path))
    (tmp_path / "cut.bvh").write_text(HUMAN + "1 2 3\n")
    assert "cut.bvh" in bvh(tmp_path / "cut.bvh")
    (tmp_path / "02.asf").unlink()
    line = acclaim(tmp_path / "02_01.amc")
    assert "02_01.amc" in line
    assert ".asf" in line
    several = {"directory": str(tmp_path), "files": [{"name": "gone.bvh"}, {"name": "cut.bvh"}]}
    assert "cut.bvh" in error_of(lambda: bpy.ops.sparse_mocap.import_bvh(**several))


def test_a_bad_file_among_several_leaves_the_others_imported(tmp_path):
    (tmp_path / "cut.bvh").write_text(HUMAN + "1 2 3\n")
    names = [_bvh(tmp_path, name="a.bvh").name, "gone.bvh", "cut.bvh", _bvh(tmp_path).name]
    imported = addon("session.imported")
    paths = [str(tmp_path / name) for name in names]
    loaded = imported.import_job(paths, (".bvh",), imported.ImportOptions()).run()
    assert [motion.name for motion in loaded.motions] == ["a", "walk"]
    assert ["gone.bvh" in loaded.problems[0], "cut.bvh" in loaded.problems[1]] == [True, True]
    files = [{"name": name} for name in names]
    bpy.ops.sparse_mocap.import_bvh(directory=str(tmp_path), files=files)
    assert sorted(bpy.data.objects.keys()) == ["a", "walk"]


def test_drops_are_offered_where_blender_takes_them():
    handler = getattr(bpy.types, "SPARSEMOCAP_FH_acclaim", None)
    assert (handler is not None) == hasattr(bpy.types, "FileHandler")
    if handler is not None:
        assert handler.bl_import_operator == "sparse_mocap.import_acclaim"
        assert handler.bl_file_extensions == ".asf;.amc"
