// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap::streams {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

// The unit g of accelerometers (ISO 80000-3), exact; kGravity_mps2 is the assumed local gravity.
inline constexpr double kStandardGravity_mps2 = 9.80665;

// Flags of a sample; bits.
enum SampleFlag : unsigned {
  kClipped = 1,          // a value is at the limit of the sensor's range
  kAfterGap = 2,         // samples are missing before this one
  kAfterReset = 4,       // the device's counter or clock restarted
  kGravityRestored = 8,  // sent without gravity, which was added using the sensor's own orientation
};

// One sensor's measurement at one instant, in SI units and the sensor's own axes: flat on a table
// with z up, specific_force is (0, 0, +9.81). NaN where the device did not send it.
struct Sample {
  int sensor = 0;             // index into StreamParser::sensor_names()
  double time_s = kAbsent;    // the device's clock, unwrapped: ascends until the next reset()
  std::int64_t counter = -1;  // the device's packet counter, unwrapped; -1: none
  Vec3 specific_force = Vec3::Constant(kAbsent);                     // m/s^2
  Vec3 angular_velocity = Vec3::Constant(kAbsent);                   // rad/s
  Eigen::Vector4d orientation = Eigen::Vector4d::Constant(kAbsent);  // R_world_sensor, w x y z
  Vec3 magnetic_field = Vec3::Constant(kAbsent);                     // in the device's unit
  unsigned flags = 0;

  bool has_specific_force() const { return specific_force.allFinite(); }
  bool has_orientation() const { return orientation.allFinite(); }
};

}  // namespace sparse_mocap::streams
