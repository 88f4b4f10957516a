// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap {

// Follows poses as a critically damped spring follows what pulls it: a joint that is somewhere else
// all at once is reached over several frames, evenly and without swinging past it.
class PoseFollower {
 public:
  // A steady turn is followed lag_s later; 0: the poses stay as they are.
  PoseFollower(double lag_s, double frame_time_s) : lag_s_(lag_s), frame_time_s_(frame_time_s) {}

  // The next pose: its rotations, and the root's height. After a reset the first.
  void apply(PoseEstimate& estimate);
  void reset() { joints_.clear(); }

 private:
  struct Joint {
    Quat rotation = Quat::Identity();
    Vec3 velocity_radps = Vec3::Zero();
  };

  double lag_s_, frame_time_s_;
  std::vector<Joint> joints_;
  double height_m_ = 0.0, climb_mps_ = 0.0;  // of the root
};

}  // namespace sparse_mocap
