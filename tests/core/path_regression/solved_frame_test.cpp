// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/solved_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

const Skeleton kSkeleton = testing::template_skeleton();

// A take at 25 Hz whose first angle and root sway at so many Hz.
std::vector<SolvedFrame> swaying_take(double frequency_hz) {
  std::vector<SolvedFrame> take(100);
  for (std::size_t t = 0; t < take.size(); ++t) {
    const double s = std::sin(2.0 * kPi * frequency_hz * static_cast<double>(t) / 25.0);
    take[t].angles = Eigen::VectorXd::Constant(kSkeleton.num_angles(), 0.1);
    take[t].angles[0] += s;
    // A full turn that says nothing must not be averaged.
    take[t].angles[5] += 2.0 * kPi * static_cast<double>(t % 3);
    take[t].positions = Eigen::VectorXd::Zero(3 * kNumStandardJoints);
    take[t].root_position = {s, 1.0, 0.0};
    take[t].yaw_rad = s;
    take[t].time_s = static_cast<double>(t);
  }
  return take;
}

std::vector<SolvedFrame> smoothed_take(double frequency_hz, double sigma_s) {
  return smoothed(swaying_take(frequency_hz), kSkeleton, 0.04, sigma_s);
}

TEST(Smoothed, IsTheTakeItselfWithoutSmoothing) {
  const auto take = smoothed_take(3.0, 0.0);
  const auto plain = swaying_take(3.0);
  for (std::size_t t = 0; t < take.size(); ++t) EXPECT_EQ(take[t].angles, plain[t].angles);
  EXPECT_TRUE(smoothed({}, kSkeleton, 0.04, 0.1).empty());
}

TEST(Smoothed, KeepsSlowMovementsInTimeAndTakesFastOnesAway) {
  const auto slow = smoothed_take(0.25, 0.08), fast = smoothed_take(8.0, 0.08);
  for (std::size_t t = 10; t < 90; ++t) {
    const double s = std::sin(2.0 * kPi * 0.25 * static_cast<double>(t) / 25.0);
    EXPECT_NEAR(slow[t].angles[0], 0.1 + s, 0.02);
    EXPECT_NEAR(slow[t].root_position.x(), s, 0.02);
    EXPECT_NEAR(slow[t].yaw_rad, s, 0.02);
    EXPECT_NEAR(fast[t].angles[0], 0.1, 0.02);
    EXPECT_NEAR(std::remainder(slow[t].angles[5] - 0.1, 2.0 * kPi), 0.0, 1e-9);
    EXPECT_EQ(slow[t].time_s, static_cast<double>(t));
  }
}

TEST(Smoothed, HasThePositionsOfItsAngles) {
  JointTransforms pose;
  for (const auto& frame : smoothed_take(1.0, 0.08)) {
    forward_kinematics(kSkeleton, Vec3::Zero(), frame.angles, pose);
    EXPECT_LT((frame.positions - stacked_ends(pose)).norm(), 1e-12);
  }
}

TEST(ToEstimate, TurnsThePoseToItsHeading) {
  testing::Random random(1);
  SolvedFrame frame;
  frame.time_s = 1.5;
  frame.angles = random.column(43, 0.6);
  frame.root_position = random.vector(2.0);
  frame.yaw_rad = 0.7;
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), frame.angles, pose);
  const PoseEstimate estimate = to_estimate(frame, kSkeleton);
  EXPECT_EQ(estimate.time_s, 1.5);
  const auto world = to_motion({estimate}, kSkeleton, 25.0).transforms(0);
  for (std::size_t j = 0; j < pose.end.size(); ++j)
    EXPECT_LT((world.end[j] - frame.root_position - yaw_rotation(0.7) * pose.end[j]).norm(), 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
