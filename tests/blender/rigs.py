# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters' rigs for the tests: made by Rigify, or with the names of other programs."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from support import Skipped, in_blenders_axes, library

LIMBS = {
    "lfemur": ("thigh", "L"),
    "ltibia": ("shank", "L"),
    "rfemur": ("thigh", "R"),
    "rtibia": ("shank", "R"),
    "lhumerus": ("upper_arm", "L"),
    "lradius": ("forearm", "L"),
    "rhumerus": ("upper_arm", "R"),
    "rradius": ("forearm", "R"),
}

_TRUNK = ("pelvis", "spine", "spine1", "spine2", "neck", "head")
_SIDED = ("clavicle", "upper_arm", "forearm", "hand", "thigh", "shank", "foot", "toe")
_TRUNK_JOINTS = ("root", "lowerback", "upperback", "thorax", "lowerneck", "head")
_JOINTS = {
    **dict(zip(_TRUNK, _TRUNK_JOINTS, strict=True)),
    "clavicle": "clavicle",
    "upper_arm": "humerus",
    "forearm": "radius",
    "hand": "wrist",
    "thigh": "femur",
    "shank": "tibia",
}
_PARENTS = {
    "spine": "pelvis", "spine1": "spine", "spine2": "spine1", "neck": "spine2", "head": "neck",
    "clavicle": "spine2", "upper_arm": "clavicle", "forearm": "upper_arm", "hand": "forearm",
    "thigh": "pelvis", "shank": "thigh", "foot": "shank", "toe": "foot",
}  # fmt: skip


@dataclass(frozen=True)
class Style:
    """How a program names bones: those of the trunk, those of a side, and how it says the side."""

    trunk: tuple[str, ...]
    sided: tuple[str, ...]
    sides: tuple[str, str]

    def name(self, part: str, side: str = "") -> str:
        if part in _TRUNK:
            return self.trunk[_TRUNK.index(part)]
        return self.sided[_SIDED.index(part)].format(self.sides[0 if side == "L" else 1])


_HUMAN_SIDED = ("{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand", "{}UpLeg", "{}Leg", "{}Foot")
STYLES = {
    "mixamo": Style(
        tuple(f"mixamorig:{n}" for n in ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head")),
        tuple(f"mixamorig:{name}" for name in (*_HUMAN_SIDED, "{}ToeBase")),
        ("Left", "Right"),
    ),
    "motionbuilder": Style(
        ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
        (*_HUMAN_SIDED, "{}ToeBase"),
        ("Left", "Right"),
    ),
    "vrm": Style(
        tuple(
            f"J_Bip_C_{name}" for name in ("Hips", "Spine", "Chest", "UpperChest", "Neck", "Head")
        ),
        tuple(
            "J_Bip_{}_" + name
            for name in (
                "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot",
                "ToeBase",
            )
        ),
        ("L", "R"),
    ),
    "unreal": Style(
        ("pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head"),
        (
            "clavicle_{}", "upperarm_{}", "lowerarm_{}", "hand_{}", "thigh_{}", "calf_{}",
            "foot_{}", "ball_{}",
        ),
        ("l", "r"),
    ),
    "auto_rig_pro": Style(
        ("c_root_master.x", "c_spine_01.x", "c_spine_02.x", "c_spine_03.x", "c_neck.x", "c_head.x"),
        (
            "c_shoulder.{}", "c_arm_fk.{}", "c_forearm_fk.{}", "c_hand_fk.{}", "c_thigh_fk.{}",
            "c_leg_fk.{}", "c_foot_fk.{}", "c_toes_fk.{}",
        ),
        ("l", "r"),
    ),
    "unknown": Style(  # recognised by its shape alone
        ("q0", "q1", "q2", "q3", "q4", "q5"),
        tuple(f"{{}}{name}" for name in "abcdefgh"),
        ("v", "w"),
    ),
}  # fmt: skip


@cache
def standard_skeleton():
    """The skeleton of the tests' database."""
    import sparse_mocap

    return sparse_mocap.MotionDatabase(library().database).skeleton


def standard_motion_of_take():
    """The walk that the tests' take was simulated from, on the skeleton of their database."""
    import sparse_mocap
    from sparse_mocap.demo_motions import generate_library

    with tempfile.TemporaryDirectory() as folder:
        walk = generate_library(Path(folder))[1]
        motion = sparse_mocap.read_motion(walk)[0]
    return sparse_mocap.to_standard(motion, standard_skeleton())[0]


def named_rig(
    style: str,
    *,
    pose: str = "t",
    rolls: bool = False,
    scale: float = 1.0,
    size: float = 1.0,
    rotation_mode: str = "QUATERNION",
    root: str = "",
):
    """An armature of the standard proportions with a program's bone names.

    pose: t or a, the rest pose; rolls: odd ones; scale: of the object, whose bones are as much
    larger; size: of the whole character; root: a bone below the pelvis.
    """
    heads, tails = _rest(pose)
    data = bpy.data.armatures.new(style)
    armature = bpy.data.objects.new(style, data)
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    named = STYLES[style]
    random = np.random.default_rng(3)
    made = {}
    if root:
        bone = data.edit_bones.new(root)
        bone.head, bone.tail = (0, 0, 0), (0, 0.2 * size / scale, 0)
        made[""] = bone
    for (part, side), head in heads.items():
        bone = data.edit_bones.new(named.name(part, side))
        bone.head = Vector(head) * size / scale
        bone.tail = Vector(tails[part, side]) * size / scale
        if rolls:
            bone.roll = random.uniform(-np.pi, np.pi)
        above = _PARENTS.get(part)
        parent = made.get((above, side), made.get((above, ""), made.get("")))
        if parent is not None:
            bone.parent = parent
        made[part, side] = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.scale = (scale,) * 3
    for bone in armature.pose.bones:
        bone.rotation_mode = rotation_mode
    bpy.context.view_layer.update()
    return armature


def _rest(pose: str) -> tuple[dict, dict]:
    """(3,) heads and tails of all bones in Blender's axes, metres, the feet on the floor."""
    import sparse_mocap

    skeleton = standard_skeleton()
    names = list(skeleton.names)
    rotations = np.zeros((1, len(names), 4))
    rotations[..., 0] = 1.0
    if pose == "a":
        for joint, sign in (("lhumerus", -1.0), ("rhumerus", 1.0)):
            angle = sign * np.radians(45.0)
            rotations[0, names.index(joint)] = [np.cos(angle / 2), 0, 0, np.sin(angle / 2)]
    motion = sparse_mocap.Motion(skeleton, 0.04, np.zeros((1, 3)), rotations)
    pivots = in_blenders_axes(motion.pivot_positions())[0]
    ends = in_blenders_axes(motion.joint_positions("world"))[0]
    lift = -ends[[names.index("ltibia"), names.index("rtibia")], 2].mean() + 0.08
    up = np.array([0.0, 0.0, lift])
    pivots, ends = pivots + up, ends + up
    heads, tails = {}, {}
    for part in _TRUNK:
        joint = names.index(_JOINTS[part])
        heads[part, ""] = pivots[joint] if part != "pelvis" else pivots[0]
    for part, after in pairwise(_TRUNK):
        tails[part, ""] = heads[after, ""]
    tails["pelvis", ""] = heads["pelvis", ""] + np.array([0, 0, 0.1])
    tails["head", ""] = heads["head", ""] + np.array([0, 0, 0.2])
    for side in "LR":
        for part in ("clavicle", "upper_arm", "forearm", "hand", "thigh", "shank"):
            joint = names.index(side.lower() + _JOINTS[part])
            heads[part, side], tails[part, side] = pivots[joint], ends[joint]
        heads["hand", side] = tails["forearm", side]
        along = tails["forearm", side] - heads["forearm", side]
        tails["hand", side] = heads["hand", side] + 0.4 * along
        ankle = tails["shank", side]
        heads["foot", side] = ankle
        tails["foot", side] = ankle + np.array([0, -0.13, -0.06])
        heads["toe", side] = tails["foot", side]
        tails["toe", side] = tails["foot", side] + np.array([0, -0.07, -0.02])
    order = [(part, "") for part in _TRUNK] + [(part, side) for side in "LR" for part in _SIDED]
    return {key: heads[key] for key in order}, tails


@cache
def _rigify_file() -> Path:
    """A .blend with a metarig and the rig that Rigify generates from it."""
    import addon_utils

    folder = Path(tempfile.mkdtemp(prefix="sparse_mocap_rigify_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    if addon_utils.enable("rigify", default_set=True) is None:
        raise Skipped("this Blender has no Rigify")
    bpy.ops.object.armature_human_metarig_add()
    bpy.context.object.name = "metarig"
    bpy.ops.pose.rigify_generate()
    path = folder / "rigify.blend"
    generated = bpy.context.object
    generated.name = "generated"
    objects = {generated, bpy.data.objects["metarig"]}
    bpy.data.libraries.write(str(path), objects)
    for obj in [*objects, *(obj for obj in bpy.data.objects if obj.name.startswith("WGT"))]:
        bpy.data.objects.remove(obj)
    return path


def rigify_rig(*, generated: bool = True):
    """Rigify's human, generated or as a metarig."""
    path = _rigify_file()
    with bpy.data.libraries.load(str(path)) as (_, here):
        here.objects = ["generated" if generated else "metarig"]
    [armature] = here.objects
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.context.view_layer.update()
    return armature


_ARP_LIMBS = {
    "hand": ("arm", "forearm", "arms_pole", 1.0),
    "foot": ("thigh", "leg", "leg_pole", -1.0),
}
_ARP_PARTS = {"arm": "upper_arm", "forearm": "forearm", "hand": "hand"}
_ARP_PARTS |= {"thigh": "thigh", "leg": "shank", "foot": "foot"}


def auto_rig_pro_rig():
    """FK and IK controls with the names of Auto-Rig Pro, and the bones that follow either.

    A skeleton made here: thigh.l, leg.l and foot.l copy the FK controls, or the IK chain, as
    c_foot_ik.l["ik_fk_switch"] says; arms alike.
    """
    armature = named_rig("auto_rig_pro", rolls=True)
    named = STYLES["auto_rig_pro"]
    bpy.ops.object.mode_set(mode="EDIT")
    edit = armature.data.edit_bones
    for end, (upper, lower, pole, behind) in _ARP_LIMBS.items():
        for side in "LR":
            low = side.lower()
            fk = {part: edit[named.name(_ARP_PARTS[part], side)] for part in (upper, lower, end)}
            fk[lower].head.y += 0.01 * behind  # a limb that is bent a little
            fk[upper].tail = fk[lower].head
            for ending in ("", "_ik"):
                above = fk[upper].parent
                for part in (upper, lower) if ending else (upper, lower, end):
                    bone = edit.new(f"{part}{ending}.{low}")
                    bone.head, bone.tail = fk[part].head, fk[part].tail
                    bone.parent, above = above, bone
            target = edit.new(f"c_{end}_ik.{low}")
            target.head, target.tail = fk[end].head, fk[end].head + Vector((0, 0.15, 0))
            control = edit.new(f"c_{pole}.{low}")
            control.head = fk[lower].head + Vector((0, 0.5 * behind, 0))
            control.tail = control.head + Vector((0, 0.1, 0))
    bpy.ops.object.mode_set(mode="OBJECT")
    for end, (upper, lower, pole, _) in _ARP_LIMBS.items():
        for low in "lr":
            _add_arp_constraints(armature, (upper, lower, end), pole, low)
    bpy.context.view_layer.update()
    return armature


def _pole_angle(armature, upper: str, lower: str, pole: str, low: str) -> float:
    """With which the limb is as at rest while all controls are."""
    bones = armature.data.bones
    head, tail = bones[upper].head_local, bones[lower].tail_local
    normal = (tail - head).cross(bones[f"c_{pole}.{low}"].head_local - head)
    along = bones[upper].tail_local - head
    wanted = normal.cross(along)
    x_axis = bones[upper].matrix_local.col[0].to_3d()
    angle = x_axis.angle(wanted)
    return -angle if x_axis.cross(wanted).dot(along) > 0.0 else angle


def _add_arp_constraints(armature, parts: tuple[str, str, str], pole: str, low: str) -> None:
    bones = armature.pose.bones
    end = parts[2]
    target = f"c_{end}_ik.{low}"
    bones[target]["ik_fk_switch"] = 0.0
    bend = bones[f"{parts[1]}_ik.{low}"].constraints.new("IK")
    bend.target = bend.pole_target = armature
    bend.subtarget, bend.pole_subtarget, bend.chain_count = target, f"c_{pole}.{low}", 2
    bend.pole_angle = _pole_angle(
        armature, f"{parts[0]}_ik.{low}", f"{parts[1]}_ik.{low}", pole, low
    )
    for part in parts:
        fk = bones[f"{part}.{low}"].constraints.new("COPY_ROTATION")
        fk.target, fk.subtarget = armature, f"c_{part}_fk.{low}"
        ik = bones[f"{part}.{low}"].constraints.new("COPY_ROTATION")
        ik.target = armature
        ik.subtarget = target if part == end else f"{part}_ik.{low}"
        if part == end:
            ik.owner_space = ik.target_space = "LOCAL_WITH_PARENT"
        driver = ik.driver_add("influence").driver
        driver.type = "SCRIPTED"
        variable = driver.variables.new()
        variable.name, variable.type = "fk", "SINGLE_PROP"
        variable.targets[0].id = armature
        variable.targets[0].data_path = f'pose.bones["{target}"]["ik_fk_switch"]'
        driver.expression = "1.0 - fk"


def limb_directions(armature, frames, limbs: dict[str, tuple[str, str]]) -> dict[str, np.ndarray]:
    """(T, 3) where limbs point in the world: from one bone's head to another's, as evaluated."""
    found: dict[str, list] = {joint: [] for joint in limbs}
    for frame in frames:
        bpy.context.scene.frame_set(int(np.floor(frame)), subframe=frame % 1.0)
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        for joint, (begin, end) in limbs.items():
            heads = [evaluated.matrix_world @ evaluated.pose.bones[n].head for n in (begin, end)]
            found[joint].append(np.array(heads[1] - heads[0]))
    return {joint: np.array(vectors) for joint, vectors in found.items()}


def wanted_directions(motion) -> dict[str, np.ndarray]:
    """(T, 3) the same on the standard skeleton."""
    names = list(motion.skeleton.names)
    begin = in_blenders_axes(motion.pivot_positions())
    end = in_blenders_axes(motion.joint_positions("world"))
    return {joint: end[:, names.index(joint)] - begin[:, names.index(joint)] for joint in LIMBS}


def degrees(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(T,) between directions."""
    return np.degrees(
        np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("ij,ij->i", a, b))
    )
