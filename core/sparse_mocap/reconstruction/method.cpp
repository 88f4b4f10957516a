// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/method.hpp"

#include <iterator>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap {

std::vector<PoseEstimate> solve_online(Method& method, const std::vector<Reading>& take,
                                       const Progress& progress) {
  method.reset();
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < take.size(); ++t) {
    progress.report(t, take.size(), "reconstructing");
    if (auto estimate = method.step(take[t])) estimates.push_back(std::move(*estimate));
  }
  auto owed = method.flush();
  std::move(owed.begin(), owed.end(), std::back_inserter(estimates));
  return estimates;
}

std::vector<Quat> joint_rotations(const PoseEstimate& estimate, const Skeleton& skeleton) {
  std::vector<Quat> rotations;
  for (int j = 0; j < skeleton.num_joints(); ++j)
    rotations.emplace_back(
        joint_rotation(skeleton.joint(j), estimate.angles.data() + skeleton.angle_begin(j)));
  rotations[0] = Quat(yaw_rotation(estimate.yaw_rad)) * rotations[0];
  return rotations;
}

Motion to_motion(const std::vector<PoseEstimate>& estimates, const Skeleton& skeleton,
                 double rate_hz) {
  Motion motion;
  motion.skeleton = skeleton;
  motion.frame_time_s = 1.0 / rate_hz;
  for (const auto& estimate : estimates) {
    motion.root_positions.push_back(estimate.root_position);
    const auto rotations = joint_rotations(estimate, skeleton);
    motion.rotations.insert(motion.rotations.end(), rotations.begin(), rotations.end());
  }
  return motion;
}

}  // namespace sparse_mocap
