// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/heading_drift.hpp"

#include <cmath>

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::liu2011 {
namespace {

// How far similar poses are from the performer's, and how long they stay so.
constexpr double kExpected_rad = 15.0 * kRadiansPerDegree;
constexpr double kExpected_s = 1.0;
constexpr double kFarthest_rad = 60.0 * kRadiansPerDegree;  // beyond it, poses are not alike

// The turn about the vertical that brings `from` nearest to `to`.
double yaw_between(const Mat3& from, const Mat3& to) {
  const Mat3 R = to * from.transpose();
  return std::atan2(R(0, 2) - R(2, 0), R(0, 0) + R(2, 2));
}

}  // namespace

HeadingDrift::HeadingDrift(std::size_t num_sensors, double drift_rad, double rate_hz)
    : drift_per_frame_(drift_rad * drift_rad / rate_hz),
      noise_per_frame_(kExpected_rad * kExpected_rad * kExpected_s * rate_hz),
      drift_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(num_sensors))),
      variance_(drift_) {}

std::vector<Observation> HeadingDrift::corrected(std::vector<Observation> observed) const {
  for (Observation& one : observed)
    one.measured.R_frame_sensor =
        yaw_rotation(-drift_[one.worn.sensor]) * one.measured.R_frame_sensor;
  return observed;
}

void HeadingDrift::update(std::span<const Observation> corrected,
                          std::span<const SensorPose> expected) {
  variance_.array() += drift_per_frame_;
  std::vector<double> turns(corrected.size());
  double common = 0.0, count = 0.0;
  bool has_position = false;
  for (std::size_t s = 0; s < corrected.size(); ++s) {
    has_position = has_position || corrected[s].has_position;
    if (!corrected[s].has_orientation) continue;
    turns[s] = yaw_between(expected[s].R_frame_sensor, corrected[s].measured.R_frame_sensor);
    common += turns[s];
    count += 1.0;
  }
  if (has_position || count == 0.0) common = 0.0;
  for (std::size_t s = 0; s < corrected.size(); ++s) {
    const double turn = turns[s] - (count > 0.0 ? common / count : 0.0);
    if (!corrected[s].has_orientation || std::abs(turn) > kFarthest_rad) continue;
    const Eigen::Index sensor = corrected[s].worn.sensor;
    const double gain = variance_[sensor] / (variance_[sensor] + noise_per_frame_);
    drift_[sensor] += gain * turn;
    variance_[sensor] *= 1.0 - gain;
  }
}

void HeadingDrift::reset() {
  drift_.setZero();
  variance_.setZero();
}

}  // namespace sparse_mocap::liu2011
