// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/standard_angles.hpp"

#include <gtest/gtest.h>

#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;

TEST(StandardAngles, GiveTheMotionBackAndDoNotJump) {
  const Motion motion = swaying_motion(template_skeleton(), 5, 100, 60.0);
  const Eigen::MatrixXd angles = standard_angles(motion);
  JointTransforms pose;
  for (int t = 0; t < motion.num_frames(); ++t) {
    forward_kinematics(motion.skeleton, motion.root_positions[static_cast<std::size_t>(t)],
                       angles.col(t), pose);
    const auto expected = motion.transforms(t);
    for (std::size_t j = 0; j < pose.end.size(); ++j)
      EXPECT_LT((pose.end[j] - expected.end[j]).norm(), 1e-9);
    if (t > 0) {
      EXPECT_LT((angles.col(t) - angles.col(t - 1)).cwiseAbs().maxCoeff(), 0.2);
    }
  }
}

}  // namespace
}  // namespace sparse_mocap
