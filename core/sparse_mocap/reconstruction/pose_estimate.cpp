// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap {

Motion to_motion(const std::vector<PoseEstimate>& estimates, const Skeleton& skeleton,
                 double rate_hz) {
  Motion motion;
  motion.skeleton = skeleton;
  motion.frame_time_s = 1.0 / rate_hz;
  for (const auto& estimate : estimates) {
    motion.root_positions.push_back(estimate.root_position);
    motion.rotations.insert(motion.rotations.end(), estimate.rotations.begin(),
                            estimate.rotations.end());
  }
  return motion;
}

}  // namespace sparse_mocap
