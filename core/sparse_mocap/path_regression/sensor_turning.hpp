// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap::path_regression {

// The sensors with all that TurningOf tells of them: those with an orientation also have the
// gravity direction and the angular velocity that follow from it and, if wanted, those with these
// two an orientation in a world of their own.
std::vector<Sensor> with_turning(std::vector<Sensor> sensors, bool with_own_headings);

// Whether the sensor's orientation is one that TurningOf works out, with a heading of its own.
bool has_own_heading(const Sensor& sensor, bool with_own_headings);

// Fills in what with_turning() adds, reading by reading, each in the memory of the one before.
//
// Orientations without a tracker follow the gyroscope, while their inclination is that of the
// gravity direction. Their heading is 0 at first and drifts with the gyroscope's bias; after a
// reading without one of the two (orientation: NaN) it begins anew.
class TurningOf {
 public:
  // sensors: as they were before with_turning().
  TurningOf(std::vector<Sensor> sensors, bool with_own_headings)
      : sensors_(std::move(sensors)), with_own_headings_(with_own_headings) {}

  const Reading& operator()(const Reading& measured);
  void reset() { before_ = {}; }

 private:
  void tell_from_orientation(const Reading& measured, Eigen::Index s);
  void turn_on(const Reading& measured, Eigen::Index s);

  std::vector<Sensor> sensors_;
  bool with_own_headings_;
  Reading told_;
  Reading before_;  // as it was told
};

}  // namespace sparse_mocap::path_regression
