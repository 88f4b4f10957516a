// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// The rows of one clip, while a database is being made; columns as in MotionDatabase.
struct DatabaseRows {
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Rows angles, positions, root_motion, contacts;
  Rows specific_force_pivot, specific_force_end, angular_velocity, gravity_direction;
  Rows extremities;  // zero where the motion has none

  int num_frames() const { return static_cast<int>(angles.rows()); }
};

// The rows of one clip: the motion, on a standard skeleton (with extremities or without) at its own
// rate, sampled at rate_hz.
DatabaseRows database_rows(const Motion& standard_motion, double rate_hz);
// The same with the readings of sensors on a body of other proportions that moves alike:
// worn_motion has the frames of standard_motion.
DatabaseRows database_rows(const Motion& standard_motion, double rate_hz,
                           const Motion& worn_motion);

}  // namespace sparse_mocap
