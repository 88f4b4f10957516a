// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/motion/humanoid_find.hpp"

namespace sparse_mocap {

// Where a source's body has the standard's bones in one posture (world, the source's lengths).
struct StandardPoints {
  std::array<Vec3, kNumStandardJoints> begin, end;
  Vec3 left_hips, left_shoulders;  // from the right joint to the left one
  Vec3 up;                         // from pelvis to neck
  std::array<Vec3, 2> foot;        // from ankle to toes; zero where unknown

  // The bone from its begin to its end; zero where the source does not have it.
  Vec3 bone(int joint) const {
    const auto at = static_cast<std::size_t>(joint);
    return end[at] - begin[at];
  }
};

// The angle between two directions, rad.
double angle_between(const Vec3& a, const Vec3& b);

StandardPoints standard_points(const Skeleton& source, const SourceJoints& joints,
                               const JointTransforms& posture);

// Forgets tips of head and hands that are none: eyes, meshes, weapons.
void drop_odd_tips(const StandardPoints& rest, SourceJoints& joints);

// How far a posture is from standing with arms down or out (rad): the largest deviation of thighs,
// shanks, arms and shoulders.
double standing_error_rad(const StandardPoints& points);

// Above this a posture is no standing body.
inline constexpr double kStanding_rad = 75.0 * kRadiansPerDegree;

}  // namespace sparse_mocap
