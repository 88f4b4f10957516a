// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/extremity_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sparse_mocap/retargeting/joint_names.hpp"
#include "sparse_mocap/retargeting/rest_alignment.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

std::vector<int> children_of(const Skeleton& rig, int parent) {
  std::vector<int> children;
  for (int j = parent + 1; j < rig.num_joints(); ++j)
    if (rig.joint(j).parent == parent) children.push_back(j);
  return children;
}

bool is_called(const Skeleton& rig, int joint, std::initializer_list<const char*> words) {
  Side side = Side::middle;
  const std::string plain = plain_part_name(rig.joint(joint).name, side);
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return plain.find(word) != std::string::npos; });
}

// The child of a foot about which its toes bend; one toe of many is none.
int toes_of(const Skeleton& rig, int foot) {
  const auto children = children_of(rig, foot);
  for (const int child : children)
    if (is_called(rig, child, {"toebase", "ball"})) return child;
  if (children.size() != 1) return -1;
  return is_called(rig, children[0], {"toe"}) ? children[0] : -1;
}

// The joint that bends the wrist: below one that only twists the forearm, or the wrist itself.
int hand_of(const Skeleton& rig, int wrist) {
  if (wrist < 0 || is_called(rig, wrist, {"hand"})) return wrist;
  for (const int child : children_of(rig, wrist))
    if (is_called(rig, child, {"hand"})) return child;
  return wrist;
}

// The world's axis that is up where a body stands; the body's own where none is near it.
Vec3 up_of(const Vec3& trunk) {
  constexpr double kNear_rad = 25.0 * kRadiansPerDegree;
  Eigen::Index axis = 0;
  trunk.cwiseAbs().maxCoeff(&axis);
  const Vec3 up = trunk[axis] > 0.0 ? Vec3(Vec3::Unit(axis)) : Vec3(-Vec3::Unit(axis));
  return angle_between(up, trunk) < kNear_rad ? up : trunk.normalized();
}

// A level foot that points where the rig's does, in its world.
Mat3 level_foot(const BonePositions& bones, std::size_t side) {
  const Vec3 up = up_of(bones.up);
  const Vec3 foot = bones.foot[side];
  const Vec3 forward = bones.left_hips.cross(up);
  const auto facing = [&](const Vec3& direction) {
    Mat3 R;
    R.col(1) = up;
    R.col(0) = up.cross(direction).normalized();
    R.col(2) = R.col(0).cross(up);
    return R;
  };
  constexpr double kPointed_rad = 65.0 * kRadiansPerDegree;
  if (foot.norm() <= 0.0) return facing(forward);
  if (angle_between(foot, -up) > 0.5 * kPi - kPointed_rad) return facing(foot);
  // The rest is no standing one: its feet hang down.
  const Mat3 R = facing(forward);
  const Skeleton standard = with_extremities(make_standard_skeleton(template_bones()));
  const Vec3 bone = R * standard.joint(extremity_joint(extremity::lfoot)).bone;
  return smallest_rotation(bone, foot) * R;
}

}  // namespace

ExtremityMapping map_extremities(const Skeleton& rig, const BodyJoints& joints,
                                 const BonePositions& bones, const JointTransforms& rest,
                                 const std::array<Mat3, 2>& R_world_wrist) {
  ExtremityMapping found;
  const auto put = [&](int e, int joint, const Mat3& R_world_standard) {
    if (joint < 0) return;
    found[at(e)].joint = joint;
    found[at(e)].R_joint_standard = rest.R_world_joint[at(joint)].transpose() * R_world_standard;
  };
  for (std::size_t side = 0; side < 2; ++side) {
    const int first = side == 0 ? extremity::lfoot : extremity::rfoot;
    const int foot = joints.ankle[side];
    if (foot >= 0) {
      const Mat3 level = level_foot(bones, side);
      put(first, foot, level);
      put(first + 1, toes_of(rig, foot), level);
    }
    put(first + 2, hand_of(rig, joints.standard[side == 0 ? lwrist : rwrist]), R_world_wrist[side]);
  }
  return found;
}

}  // namespace sparse_mocap
