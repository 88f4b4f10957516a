// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

// A stretch of what one sensor read, one column a sample, in the sensor's own axes unless
// said otherwise.
struct SensorRecording {
  std::vector<double> times_s;        // ascending
  Eigen::Matrix3Xd specific_force;    // m/s^2, or g while it is not calibrated
  Eigen::Matrix3Xd angular_velocity;  // rad/s; no columns when there is no gyroscope
  Eigen::Matrix3Xd position{};        // m, world; no columns when it was not tracked
  Eigen::Matrix4Xd orientation{};     // R_world_sensor, w x y z; no columns when it was not told

  bool has_gyroscope() const { return angular_velocity.cols() > 0; }
  Eigen::Index num_samples() const { return specific_force.cols(); }
  // Seconds per sample, on average.
  double sample_time_s() const {
    const auto n = times_s.size();
    return n < 2 ? 0.0 : (times_s.back() - times_s.front()) / static_cast<double>(n - 1);
  }
};

}  // namespace sparse_mocap
