// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/liu2011/worn_sensors.hpp"

namespace sparse_mocap::liu2011 {

// How far each sensor's heading has drifted from the others': a Kalman filter a sensor, whose state
// is a random walk and whose measurement is the turn about the vertical between the sensor and
// where poses like the performer's have it. Headings agree at the beginning.
class HeadingDrift {
 public:
  // drift_rad: deviation of a heading's change in a second.
  HeadingDrift(std::size_t num_sensors, double drift_rad, double rate_hz);

  double of(Eigen::Index sensor) const { return drift_[sensor]; }  // rad

  // The sensors with their headings set right.
  std::vector<Observation> corrected(std::vector<Observation> observed) const;

  // Learns from corrected sensors and where they are expected, in their order and frame. Without
  // any position the body turns with the sensors, so what is common to all of them is no drift.
  void update(std::span<const Observation> corrected, std::span<const SensorPose> expected);

  void reset();

 private:
  double drift_per_frame_, noise_per_frame_;  // variances, rad^2
  Eigen::VectorXd drift_, variance_;
};

}  // namespace sparse_mocap::liu2011
