// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/standard_angles.hpp"

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

Eigen::MatrixXd standard_angles(const Motion& motion) {
  Eigen::MatrixXd angles = Eigen::MatrixXd::Zero(kNumStandardAngles, motion.num_frames());
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j) {
      const int begin = motion.skeleton.angle_begin(j);
      const double* reference = t > 0 ? &angles(begin, t - 1) : nullptr;
      joint_angles(motion.skeleton.joint(j), motion.rotation(t, j).toRotationMatrix(), reference,
                   &angles(begin, t));
    }
  }
  return angles;
}

}  // namespace sparse_mocap
