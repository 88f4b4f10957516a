// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/streams/sample.hpp"

namespace sparse_mocap::streams {

// Devices report rotations into worlds with z up or down, in which x is north or east.
inline Eigen::Vector4d orientation_from_z_up(const Quat& R_device_world_sensor) {
  return wxyz_of(kR_world_zup * R_device_world_sensor);
}

inline Quat z_up_from_orientation(const Eigen::Vector4d& orientation) {
  return kR_world_zup.conjugate() * quaternion_of(orientation);
}

inline Eigen::Vector4d orientation_from_z_down(const Quat& R_device_world_sensor) {
  return orientation_from_z_up(Quat(0.0, 1.0, 0.0, 0.0) * R_device_world_sensor);
}

// Roll, pitch and yaw in radians as the devices mean them: Rz(yaw) Ry(pitch) Rx(roll).
inline Quat from_roll_pitch_yaw(double roll, double pitch, double yaw) {
  return Quat(Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
              Eigen::AngleAxisd(roll, Vec3::UnitX()));
}

inline Quat rotation_of(const Sample& sample) {
  return quaternion_of(sample.orientation).normalized();
}

// Adds the gravity that a device removed, using the sample's own orientation.
inline void restore_gravity(Sample& sample, const Vec3& linear_acceleration) {
  sample.specific_force =
      linear_acceleration + rotation_of(sample).conjugate() * (kGravity_mps2 * kUp);
  sample.flags |= kGravityRestored;
}

inline Vec3 without_gravity(const Sample& sample) {
  return sample.specific_force - rotation_of(sample).conjugate() * (kGravity_mps2 * kUp);
}

}  // namespace sparse_mocap::streams
