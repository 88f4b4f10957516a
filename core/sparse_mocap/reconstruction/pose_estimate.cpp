// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/pose_estimate.hpp"

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap {

std::vector<Quat> pose_rotations(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                                 double yaw_rad) {
  std::vector<Quat> rotations;
  for (int j = 0; j < skeleton.num_joints(); ++j)
    rotations.emplace_back(
        joint_rotation(skeleton.joint(j), angles.data() + skeleton.angle_begin(j)));
  rotations[0] = Quat(yaw_rotation(yaw_rad)) * rotations[0];
  return rotations;
}

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
