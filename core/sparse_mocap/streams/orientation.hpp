// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/streams/sample.hpp"

namespace sparse_mocap::streams {

// Devices report rotations into worlds with z up or down, in which x is north or east. Which way
// is north does not matter here, so such a world becomes the project's (y up) by exchanging axes:
// what was x is then z, y is x, z is y.
inline Eigen::Vector4d orientation_from_z_up(const Quat& R_device_world_sensor) {
  const Quat q = Quat(0.5, -0.5, -0.5, -0.5) * R_device_world_sensor;
  return {q.w(), q.x(), q.y(), q.z()};
}

inline Quat z_up_from_orientation(const Eigen::Vector4d& orientation) {
  return Quat(0.5, 0.5, 0.5, 0.5) *
         Quat(orientation[0], orientation[1], orientation[2], orientation[3]);
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
  const auto& q = sample.orientation;
  return Quat(q[0], q[1], q[2], q[3]).normalized();
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
