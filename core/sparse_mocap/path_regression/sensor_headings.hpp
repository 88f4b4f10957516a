// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <complex>
#include <span>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap::path_regression {

// How sensors are turned about the vertical against one another. Retrieved poses tell it: in the
// mean over a while, each sensor points where it does on them, but for one turn of all, which is
// the performer's heading.
//
// Orientations that were worked out here (sensor_turning.hpp) have a heading of their own. It is
// known once poses have agreed on it for kSettled_s; until those of all sensors that are heard are
// known none of them is used: a few orientations would not mean what those of the database do.
//
// Trackers share one heading at first, and drift apart. What poses say against it is believed as
// far as it exceeds what may be the performer's style.
struct HeadingSettings {
  std::vector<bool> is_own;  // by sensor; the others are trackers, or without an orientation
  double rate_hz = 25.0;
  // Time constant of the mean: slow against movement, fast against drift.
  double memory_s = 20.0;
  static constexpr double kSettled_s = 0.5;
  static constexpr double kStyle_rad = 0.2;
};

// The argument is a turn about the vertical, the modulus how much it is to be trusted.
using TrustedTurn = std::complex<double>;

// What a retrieved pose says of a sensor's heading.
struct HeadingHint {
  bool is_heard = false;   // whether the sensor has an orientation
  TrustedTurn turn = 0.0;  // from its own world to the pose's heading frame, trusted by 2 at most
};

// R_heading_sensor: of the retrieved pose; a mean of rotations that disagree counts less.
HeadingHint heading_hint(const Eigen::Vector4d& orientation, const Mat3& R_heading_sensor);
// The hints of all sensors; R_heading_sensor is zero where the pose says nothing of one.
void put_heading_hints(const Reading& reading, std::span<const Mat3> R_heading_sensor,
                       std::vector<HeadingHint>& hints);

// Hints without a turn, which say only which sensors are heard.
void put_no_hints(const Reading& reading, std::vector<HeadingHint>& hints);

// Turns orientations by these offsets; NaN where one is NaN.
void turn_headings(std::span<const double> offsets_rad, Reading& reading);

// Reading by reading, from the past alone.
class SensorHeadings {
 public:
  explicit SensorHeadings(HeadingSettings settings);

  // By sensor, rad; NaN while it is unknown.
  std::span<const double> offsets_rad() const { return offsets_rad_; }
  // Returns the turn of all sensors to the heading frame, rad.
  double observe(std::span<const HeadingHint> hints);
  void reset();

 private:
  double common_rad(std::span<const HeadingHint> hints) const;

  HeadingSettings settings_;
  std::vector<TrustedTurn> sums_;
  std::vector<double> offsets_rad_;
};

// The same over a whole take: offsets_rad by reading and sensor, from the past and the future.
std::vector<std::vector<double>> whole_take_offsets(
    const HeadingSettings& settings, const std::vector<std::vector<HeadingHint>>& hints);

}  // namespace sparse_mocap::path_regression
