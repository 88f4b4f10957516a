// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sparse_mocap {

// The one place that states the conventions of the project.
//
// Units      SI: metres, seconds, radians, m/s^2. Degrees and file units live in readers and UIs.
// World      right-handed, y up. A character in rest pose faces +z, its left is +x.
// Transforms T_parent_child maps coordinates of child to coordinates of parent; R_world_sensor
//            likewise for rotations.
// Heading    the frame of a character with only root position (on the ground) and heading removed:
//            y up, x to the character's left, z forward.
// Words      specific_force is what an accelerometer reads (+9.81 on the up axis at rest);
//            linear_acceleration has gravity removed.

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

inline constexpr double kGravity_mps2 = 9.81;
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

inline const Vec3 kUp = Vec3::UnitY();

}  // namespace sparse_mocap
