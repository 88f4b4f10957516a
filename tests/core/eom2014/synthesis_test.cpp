// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/synthesis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/eom2014/training_sequence.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::eom2014 {
namespace {

using sparse_mocap::testing::resting_motion;
using sparse_mocap::testing::template_skeleton;

TEST(EomSynthesis, TheRootFollowsItsVelocityInItsHeading) {
  const int n = 61;
  Eigen::MatrixXd poses = Eigen::MatrixXd::Zero(n, kNumPoseChannels);
  poses.col(kHeightChannel).setConstant(0.9);
  Eigen::MatrixX3d velocities(n, 3);
  const double turning_radps = 0.5 * kPi / 2.0;  // a quarter turn in two seconds
  velocities.rowwise() = Eigen::RowVector3d(0.0, 1.0, turning_radps);
  const Motion motion = motion_of(template_skeleton(), 30.0, poses, velocities);
  const double radius_m = 1.0 / turning_radps;
  EXPECT_NEAR(motion.root_positions.back().x(), radius_m, 0.02);
  EXPECT_NEAR(motion.root_positions.back().z(), radius_m, 0.02);
  EXPECT_DOUBLE_EQ(motion.root_positions.back().y(), 0.9);
}

TEST(EomSynthesis, SmoothingTurnsHalfOfTheWayToTheMiddleOfTheNeighbours) {
  Motion motion = resting_motion(template_skeleton(), 5, 30.0);
  const auto turned = [](double angle) { return Quat(Eigen::AngleAxisd(angle, kUp)); };
  motion.rotation(2, 4) = turned(0.8);
  smooth_rotations(motion, 2);
  // Of angles about one axis it is the kernel (1/4, 1/2, 1/4), here applied twice between fixed
  // ends.
  for (const auto& [frame, angle] : {std::pair{0, 0.0}, {1, 0.2}, {2, 0.3}, {3, 0.2}, {4, 0.0}})
    EXPECT_LT(motion.rotation(frame, 4).angularDistance(turned(angle)), 1e-9) << frame;
}

TEST(EomSynthesis, StandingFeetStay) {
  Motion motion = resting_motion(template_skeleton(), 40, 30.0);
  for (int t = 0; t < 40; ++t) motion.root_positions[static_cast<std::size_t>(t)].z() = 0.01 * t;
  stop_skating(motion);
  for (int t = 5; t < 35; ++t)
    EXPECT_NEAR(motion.root_positions[static_cast<std::size_t>(t)].z(),
                motion.root_positions[5].z(), 1e-6)
        << t;
}

}  // namespace
}  // namespace sparse_mocap::eom2014
