// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"

namespace sparse_mocap::path_regression {

// The points (see pose_points) of the database frames that one reading retrieves. Paths go on
// through the same clips, so that about half of these frames were retrieved by the reading before:
// their points are kept from one reading to the next.
class RecentPoints {
 public:
  // For the next reading, which retrieves most_frames at most. Points of the last one are forgotten
  // if it had another user; no two users have the same number.
  void begin(std::uint64_t user, const MotionDatabase& database, double lever_m,
             std::size_t most_frames);
  // The points of a frame, until the next call of begin. Frames come in ascending order.
  const Eigen::VectorXd& of(int frame);

 private:
  struct Kept {
    int frame = -1;
    Eigen::VectorXd points;
  };
  struct Reading {
    std::vector<Kept> frames;
    std::size_t num_known = 0;  // of them, the first ones
  };

  const MotionDatabase* database_ = nullptr;
  double lever_m_ = 0.0;
  std::uint64_t user_ = 0;
  Reading now_, before_;
  std::size_t next_before_ = 0;
  Eigen::VectorXd angles_;
  JointTransforms pose_;
};

}  // namespace sparse_mocap::path_regression
