# SPDX-License-Identifier: GPL-3.0-or-later
"""Other skeletons on the standard one, and back.

The judge of real files shares nothing with the mapping: it knows for each exporter which joints
bound a limb, and compares their directions in the file with the standard skeleton's.
"""

from __future__ import annotations

import json
import re
import tarfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import sparse_mocap
from click.testing import Result
from numpy.typing import NDArray
from sparse_mocap import Motion, read_motion, standard_motion
from sparse_mocap.inspection import inspect_motion

Cli = Callable[..., Result]

STANDARD_LIMBS = {
    f"{side} {limb}": (f"{side[0]}{begin}", f"{side[0]}{end}")
    for side in ("left", "right")
    for limb, begin, end in (
        ("thigh", "hipjoint", "femur"),
        ("shank", "femur", "tibia"),
        ("upper arm", "clavicle", "humerus"),
        ("forearm", "humerus", "radius"),
    )
}
"""The standard joints whose ends bound each limb."""

EXPORTERS = {
    "Mixamo and MotionBuilder": (
        "{S}UpLeg", "{S}Leg", "{S}Foot", "{S}Arm", "{S}ForeArm", "{S}Hand",
    ),
    "Vicon": ("{S}Hip", "{S}Knee", "{S}Ankle", "{S}Shoulder", "{S}Elbow", "{S}Wrist"),
    "Xsens": (
        "{S}UpperLeg", "{S}LowerLeg", "{S}Foot", "{S}UpperArm", "{S}Forearm|{S}ForeArm", "{S}Hand",
    ),
    "MakeHuman": (
        "upperleg01.{s}", "lowerleg01.{s}", "foot.{s}", "upperarm01.{s}", "lowerarm01.{s}",
        "wrist.{s}",
    ),
    "Daz": ("{l}Thigh", "{l}Shin", "{l}Foot", "{l}Shldr", "{l}ForeArm", "{l}Hand"),
    "Bandai Namco": (
        "UpperLeg_{s}", "LowerLeg_{s}", "Foot_{s}", "UpperArm_{s}", "LowerArm_{s}", "Hand_{s}",
    ),
}  # fmt: skip
"""Names of hip, knee, ankle, shoulder, elbow and wrist."""


def _joints(names: list[str], patterns: tuple[str, ...], side: str) -> list[int] | None:
    bare = [name.rsplit(":", 1)[-1] for name in names]
    found = []
    for pattern in patterns:
        wanted = pattern.format(S=side.capitalize(), s=side[0].upper(), l=side[0])
        places = [i for i, name in enumerate(bare) if re.fullmatch(wanted, name)]
        if not places:
            return None
        found.append(places[0])
    return found


def _source_limbs(motion: Motion) -> dict[str, NDArray[np.float64]] | None:
    """Limb directions (T, 3) in the file; None for an exporter that the judge does not know."""
    pivots = motion.pivot_positions()
    for patterns in EXPORTERS.values():
        limbs = {}
        for side in ("left", "right"):
            joints = _joints(motion.skeleton.names, patterns, side)
            if joints is None:
                break
            hip, knee, ankle, shoulder, elbow, wrist = joints
            for limb, begin, end in (
                ("thigh", hip, knee), ("shank", knee, ankle),
                ("upper arm", shoulder, elbow), ("forearm", elbow, wrist),
            ):  # fmt: skip
                limbs[f"{side} {limb}"] = pivots[:, end] - pivots[:, begin]
        if len(limbs) == len(STANDARD_LIMBS):
            return limbs
    return None


def _angles_deg(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    sines = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.degrees(np.arctan2(sines, (a * b).sum(-1)))


def _limb_errors_deg(motion: Motion) -> NDArray[np.float64] | None:
    """(8, T) angles between the limbs of a motion and of the standard skeleton."""
    source = _source_limbs(motion)
    if source is None:
        return None
    mapping = sparse_mocap.map_skeleton(motion)
    standard, _ = mapping.to_standard(motion)
    lead = motion.num_frames - standard.num_frames
    ends = standard.joint_positions("world")
    names = standard.skeleton.names
    return np.array(
        [
            _angles_deg(
                source[limb][lead:] @ mapping.R_world_file.T,
                ends[:, names.index(end)] - ends[:, names.index(begin)],
            )
            for limb, (begin, end) in STANDARD_LIMBS.items()
        ]
    )


def _extracted(files: tarfile.TarFile, member: tarfile.TarInfo, folder: Path) -> Path:
    path = folder / Path(member.name).name
    content = files.extractfile(member)
    assert content is not None
    path.write_bytes(content.read())
    return path


def test_limbs_of_every_exporter_point_where_they_did(real_data: Path) -> None:
    judged = set()
    for path in sorted((real_data / "bvh_exporters").rglob("*.bvh")):
        motion, _ = read_motion(path)
        if any("position channels" in note for note in inspect_motion(path).warnings):
            continue  # such files do not say where their joints are: they say it relatively
        errors = _limb_errors_deg(motion)
        if errors is None:
            continue
        assert errors.mean() < 1.5, path
        judged.add(path.parent.name)
    assert len(judged) >= 9, judged


def test_limbs_of_bones_along_their_joints_axes_point_where_they_did(
    real_data: Path, tmp_path: Path
) -> None:
    archive = real_data / "bandai_namco" / "bandai_namco_subset.tar.xz"
    count = 0
    with tarfile.open(archive) as files:
        for member in files:
            if not member.name.endswith("_001.bvh") or count >= 12:
                continue
            errors = _limb_errors_deg(read_motion(_extracted(files, member, tmp_path))[0])
            assert errors is not None
            assert errors.mean() < 0.5, member.name
            count += 1
    assert count == 12


def test_a_rest_pose_is_matched_alike_in_every_clip(real_data: Path, tmp_path: Path) -> None:
    """Two clips of one rig, in each of which the body stands differently."""
    archive = real_data / "bandai_namco" / "bandai_namco_subset.tar.xz"
    bones = []
    with tarfile.open(archive) as files:
        for member in files:
            if "_walk" not in member.name or not member.name.endswith("_001.bvh"):
                continue
            standard, _ = standard_motion(read_motion(_extracted(files, member, tmp_path))[0])
            bones.append(standard.skeleton.bones)
            if len(bones) == 5:
                break
    limbs = [standard.skeleton.names.index(end) for _, end in STANDARD_LIMBS.values()]
    for other in bones[1:]:
        np.testing.assert_allclose(other[limbs], bones[0][limbs], atol=1e-4)
        np.testing.assert_allclose(other, bones[0], atol=2e-2)


def _there_and_back_deg(motion: Motion) -> NDArray[np.float64] | None:
    """(8, T) angles between the limbs of a motion and of its way to the standard and back."""
    before = _source_limbs(motion)
    if before is None:
        return None
    mapping = sparse_mocap.map_skeleton(motion)
    after = _source_limbs(mapping.to_rig(mapping.to_standard(motion)[0]))
    assert after is not None
    frames = len(next(iter(after.values())))
    return np.array([_angles_deg(before[limb][-frames:], after[limb]) for limb in STANDARD_LIMBS])


def test_limbs_point_where_they_did_after_the_way_there_and_back(performance: Path) -> None:
    errors = _there_and_back_deg(read_motion(performance)[0])
    assert errors is not None
    assert errors.mean() < 0.2
    assert errors.max() < 3.0


def test_limbs_of_every_exporter_point_where_they_did_after_the_way_there_and_back(
    real_data: Path,
) -> None:
    judged = set()
    for path in sorted((real_data / "bvh_exporters").rglob("*.bvh")):
        if any("position channels" in note for note in inspect_motion(path).warnings):
            continue  # as above
        errors = _there_and_back_deg(read_motion(path)[0])
        if errors is None:
            continue
        assert errors.mean() < 1.5, path
        judged.add(path.parent.name)
    assert len(judged) >= 9, judged


def test_a_movement_of_one_body_reaches_another(performance: Path, tmp_path: Path) -> None:
    """The other body is 1.25 times as large: so is its way, and its limbs point alike."""
    motion = read_motion(performance)[0]
    mapping = sparse_mocap.map_skeleton(motion)
    standard, _ = mapping.to_standard(motion)
    text = performance.read_text(encoding="utf-8")
    head, frames = text.split("MOTION")
    large = tmp_path / "large.bvh"
    large.write_text(
        re.sub(
            r"OFFSET (.*)",
            lambda match: "OFFSET " + " ".join(str(1.25 * float(x)) for x in match[1].split()),
            head,
        )
        + "MOTION"
        + frames
    )
    there = sparse_mocap.map_skeleton(read_motion(large)[0]).to_rig(standard)
    limbs, ends = _source_limbs(there), standard.joint_positions("world")
    assert limbs is not None
    for limb, joints in STANDARD_LIMBS.items():
        begin, end = (standard.skeleton.names.index(joint) for joint in joints)
        assert _angles_deg(limbs[limb], ends[:, end] - ends[:, begin]).max() < 0.01, limb
    np.testing.assert_allclose(there.root_positions, 1.25 * motion.root_positions, atol=5e-3)


def test_a_motion_that_is_not_on_the_standard_skeleton_goes_to_no_rig(performance: Path) -> None:
    motion = read_motion(performance)[0]
    with pytest.raises(ValueError, match="not on a standard skeleton"):
        sparse_mocap.map_skeleton(motion).to_rig(motion)


@pytest.mark.parametrize(
    ("old", "new"), [("HumanoidMapping", "SkeletonMapping"), ("map_humanoid", "map_skeleton")]
)
def test_old_names_say_what_to_write_now(old: str, new: str) -> None:
    with pytest.warns(DeprecationWarning, match=rf"write sparse_mocap\.{new}$"):
        assert getattr(sparse_mocap, old) is getattr(sparse_mocap, new)


@pytest.fixture
def strange(tmp_path: Path, performance: Path) -> Path:
    """The performance by someone whose joints have names that tell nothing."""
    text = performance.read_text(encoding="utf-8")
    number = iter(range(1000))
    path = tmp_path / "strange.bvh"
    path.write_text(
        re.sub(r"(ROOT|JOINT) \S+", lambda match: f"{match[1]} bone{next(number)}", text),
        encoding="utf-8",
    )
    return path


def test_a_body_is_found_by_its_shape(strange: Path, performance: Path) -> None:
    found, expected = inspect_motion(strange), inspect_motion(performance)
    assert (found.found_by, expected.found_by) == ("shape", "names")
    assert found.standard is not None
    assert expected.standard is not None
    difference = found.standard.joint_positions() - expected.standard.joint_positions()
    assert np.linalg.norm(difference, axis=-1).mean() < 0.02


def test_a_mapping_by_hand_is_remembered_until_it_is_forgotten(
    cli: Cli, strange: Path, tmp_path: Path
) -> None:
    saved = tmp_path / "map.json"
    cli("inspect", strange, "--save-mapping", saved)
    mapping = json.loads(saved.read_text(encoding="utf-8"))
    mapping["joints"]["head"] = mapping["joints"]["thorax"]
    saved.write_text(json.dumps(mapping), encoding="utf-8")
    told = cli("inspect", strange, "--mapping", saved, "--remember")
    assert "remembered in" in told.output
    after = inspect_motion(strange)
    assert after.found_by == "hand"
    assert after.mapping is not None
    assert after.mapping.joints["head"] == mapping["joints"]["thorax"]
    assert any("using the mapping remembered" in warning for warning in after.warnings)
    cli("inspect", strange, "--forget")
    assert inspect_motion(strange).found_by == "shape"


def test_databases_are_built_as_mappings_say(cli: Cli, strange: Path, tmp_path: Path) -> None:
    found = inspect_motion(strange).mapping
    assert found is not None
    joints = {"head": found.joints["thorax"]}
    told, path = tmp_path / "map.json", tmp_path / "db.smdb"
    sparse_mocap.write_mapping(told, joints)
    assert cli("database", "build", strange, "-o", path, "--mapping", told).exit_code == 0
    (by_hand,) = sparse_mocap.MotionDatabase(path).skeletons
    assert cli("inspect", strange, "--mapping", told, "--remember").exit_code == 0
    assert cli("database", "build", strange, "-o", path).exit_code == 0
    (remembered,) = sparse_mocap.MotionDatabase(path).skeletons
    assert by_hand.joints == remembered.joints
    assert by_hand.joints["head"] == joints["head"] != found.joints["head"]


def test_a_mapping_that_names_no_joint_says_which_is_nearest(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    path = tmp_path / "map.json"
    path.write_text('{"format": "sparse_mocap_mapping", "joints": {"lfemur": "LeftUpLegg"}}')
    result = cli("inspect", performance, "--mapping", path)
    assert result.exit_code == 1
    assert "the nearest is" in result.output


def test_inspect_shows_refusals_and_draws_a_sheet(cli: Cli, library: Path, tmp_path: Path) -> None:
    folder = tmp_path / "motions"
    folder.mkdir()
    (folder / "broken.bvh").write_text("HIERARCHY\n", encoding="utf-8")
    good = next(library.glob("*.bvh"))
    (folder / good.name).write_bytes(good.read_bytes())
    sheet, report = tmp_path / "sheet.png", tmp_path / "report.json"
    shown = cli("inspect", folder, "--plot", sheet, "--json", report).output
    assert "rejected" in shown
    assert good.name in shown
    assert sheet.read_bytes().startswith(b"\x89PNG")
    described = {Path(row["path"]).name: row for row in json.loads(report.read_text())}
    assert described["broken.bvh"]["refusal"]
    assert described[good.name]["limb_errors_deg"]["lfemur"]["mean"] < 0.5


def test_a_skeleton_made_of_its_rest_pose() -> None:
    names, parents = ["hips", "leg", "foot"], [-1, 0, 1]
    pivots = np.array([[0.0, 1.0, 0.0], [0.1, 0.9, 0.0], [0.1, 0.1, 0.05]])
    ends = np.array([[0.0, 1.1, 0.0], [0.1, 0.1, 0.0], [0.1, 0.0, 0.2]])
    skeleton = sparse_mocap.Skeleton(names, parents, pivots, ends)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (1, 3, 1))
    motion = sparse_mocap.Motion(skeleton, 0.1, pivots[:1], rotations)
    np.testing.assert_allclose(motion.pivot_positions()[0], pivots, atol=1e-12)
    np.testing.assert_allclose(motion.joint_positions("world")[0], ends, atol=1e-12)
    with pytest.raises(ValueError, match="leg"):
        sparse_mocap.Skeleton(["hips", "leg", "leg"], parents, pivots, ends)
    with pytest.raises(ValueError, match="parents"):
        sparse_mocap.Skeleton(names, parents[:2], pivots, ends)
    with pytest.raises(ValueError, match="pivots"):
        sparse_mocap.Skeleton(names, parents, pivots[:2], ends)


def test_only_turned_joints_move_on_a_rig() -> None:
    skeleton = sparse_mocap.body_of_height(1.75).skeleton
    frames, joints = 5, len(skeleton.names)
    random = np.random.default_rng(1)
    rotations = np.array([1.0, 0.0, 0.0, 0.0]) + random.normal(0.0, 0.1, (frames, joints, 4))
    still = sparse_mocap.Motion(skeleton, 0.1, np.zeros((frames, 3)), rotations)
    mapping = sparse_mocap.map_skeleton(still)
    moved = mapping.to_rig(still)
    changes = np.ptp(moved.rotations, axis=0).max(axis=1)
    moving = {skeleton.names[joint] for joint in np.flatnonzero(changes > 1e-9)}
    assert moving == set(mapping.turned_joints)
    assert set(mapping.joints.values()) >= moving
    assert mapping.ankles == ("", "")
