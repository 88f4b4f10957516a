// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::path_regression {

// The sensors as orientations are used: together with the gravity direction and the angular
// velocity that follow from one, and without any where none is on trunk or head, whose heading
// limbs do not tell.
std::vector<Sensor> with_turning(std::vector<Sensor> sensors);

// Fills that in, reading by reading, each in the memory of the one before.
class TurningOf {
 public:
  // sensors: as they were before with_turning().
  explicit TurningOf(std::vector<Sensor> sensors);

  const Reading& operator()(const Reading& measured);
  void reset() { before_ = {}; }

 private:
  std::vector<Sensor> sensors_;
  Reading told_;
  Reading before_;  // as it was measured
};

// Turns the limbs with sensors as these measure it, from where retrieved poses have elbows, knees,
// neck and pelvis; one turn about the vertical, common to all sensors, is fitted to the points.
// points: as pose_points, with the same lever; row: a row of the signals.
void place_oriented_limbs(const Skeleton& skeleton, std::span<const retrieval::Signal> signals,
                          const Eigen::Ref<const Eigen::RowVectorXf>& row, double lever_m,
                          Eigen::VectorXd& points);

}  // namespace sparse_mocap::path_regression
