// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/retargeting/body_joints.hpp"

namespace sparse_mocap {

// Where a rig has the standard skeleton's bones in one pose (world, the rig's lengths).
struct BonePositions {
  std::array<Vec3, kNumStandardJoints> begin, end;
  Vec3 left_hips, left_shoulders;  // from the right joint to the left one
  Vec3 up;                         // from pelvis to neck
  std::array<Vec3, 2> foot;        // from ankle to toes; zero where unknown

  // The bone from its begin to its end; zero where the rig does not have it.
  Vec3 vector(int joint) const {
    const auto at = static_cast<std::size_t>(joint);
    return end[at] - begin[at];
  }
};

// The angle between two directions, rad.
double angle_between(const Vec3& a, const Vec3& b);

BonePositions bone_positions(const Skeleton& rig, const BodyJoints& joints,
                             const JointTransforms& pose);

// Forgets tips of head and hands that are none: eyes, meshes, weapons.
void drop_odd_tips(const BonePositions& rest, BodyJoints& joints);

// How far a pose is from standing with arms down or out (rad): the largest deviation of thighs,
// shanks, arms and shoulders.
double standing_error_rad(const BonePositions& bones);

// Above this a pose is no standing body.
inline constexpr double kStanding_rad = 75.0 * kRadiansPerDegree;

}  // namespace sparse_mocap
