// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// What one sensor measured at one instant, in its own axes unless said otherwise; NaN where it did
// not.
struct SensorSample {
  static constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

  Vec3 specific_force = Vec3::Constant(kAbsent);                     // m/s^2
  Vec3 angular_velocity = Vec3::Constant(kAbsent);                   // rad/s
  Vec3 position = Vec3::Constant(kAbsent);                           // m, world
  Eigen::Vector4d orientation = Eigen::Vector4d::Constant(kAbsent);  // R_world_sensor, w x y z

  // Whether any of these channels is there; the direction of gravity takes a specific force and an
  // angular velocity.
  bool has_any(Channels channels) const;
};

// What turns a sensor's samples into those of an ideal sensor at its site.
struct SensorCorrection {
  double scale = 1.0;                     // specific forces times this are m/s^2
  Mat3 R_site_sensor = Mat3::Identity();  // applied after the scale
  Vec3 gyroscope_bias = Vec3::Zero();     // rad/s, sensor axes
  // m, site axes: where it sits, seen from its site. Positions move to the site where the
  // orientation is known.
  Vec3 offset_m = Vec3::Zero();

  SensorSample operator()(const SensorSample& sample) const;
};

// Where a tracker's world stands in the performer's: turned about the vertical, then moved.
struct TrackerWorld {
  double yaw_rad = 0.0;          // about y (up)
  Vec3 origin_m = Vec3::Zero();  // of the tracker's world

  // Turns the orientation and moves the position; the rest is in the sensor's axes.
  SensorSample operator()(const SensorSample& sample) const;
};

// One sample of a recording.
SensorSample sample_at(const SensorRecording& recording, Eigen::Index index);

// What a recording tells: a gyroscope that never turned tells nothing, since devices without one
// may send zeros.
Channels channels_of(const SensorRecording& recording);

}  // namespace sparse_mocap
