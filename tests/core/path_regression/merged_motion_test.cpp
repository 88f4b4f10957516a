// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/merged_motion.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/heading.hpp"
#include "support/random.hpp"

namespace sparse_mocap::path_regression {
namespace {

Mat3 bent(double rad) { return Eigen::AngleAxisd(rad, Vec3::UnitX()).toRotationMatrix(); }

// Walks straight on at 0.1 m a frame, height 0.9 m, bent so much.
std::vector<FittedFrame> walk(double bend_rad, std::size_t count) {
  std::vector<FittedFrame> frames;
  for (std::size_t t = 0; t < count; ++t)
    frames.push_back({{bent(bend_rad)}, Vec3(0.0, 0.9, 0.1 * static_cast<double>(t)), 0.0});
  return frames;
}

TEST(RootStep, LeadsBackToTheFrameThatItIsFrom) {
  testing::Random random(1);
  const FittedFrame before{{bent(0.0)}, random.vector(1.0), 0.7};
  const FittedFrame frame{{bent(0.3)}, random.vector(1.0), -0.4};
  const FittedFrame again = after(before, root_step(before, frame), frame);
  EXPECT_LT((again.root_position - frame.root_position).norm(), 1e-12);
  EXPECT_NEAR(again.yaw_rad, frame.yaw_rad, 1e-12);
}

TEST(MergedMotion, IsTheFirstOneWhereTheOtherCountsNothing) {
  const auto first = walk(0.2, 8);
  const auto out = merged(first, std::vector<OtherFrame>(8));
  for (std::size_t t = 0; t < 8; ++t) {
    EXPECT_EQ(out[t].rotations[0], first[t].rotations[0]);
    EXPECT_LT((out[t].root_position - first[t].root_position).norm(), 1e-12);
  }
}

TEST(MergedMotion, GoesOnFromWhereTheOtherHasComeTo) {
  const auto first = walk(0.2, 8);
  std::vector<OtherFrame> others(8);
  // Turns a quarter to the left in frame 3, bends to 0.6 there, and rises.
  others[3] = {{{bent(0.6)}, Vec3(0.0, 1.1, 0.0), 0.0}, {Vec3(0.0, 0.0, 0.1), 0.5 * kPi}, 1.0};
  others[4] = {{{bent(0.6)}, Vec3(0.0, 1.1, 0.0), 0.0}, {Vec3(0.0, 0.0, 0.1), 0.0}, 0.5};
  const auto out = merged(first, others);
  EXPECT_LT((out[3].rotations[0] - bent(0.6)).norm(), 1e-9);
  EXPECT_LT((out[4].rotations[0] - bent(0.4)).norm(), 1e-9);
  EXPECT_LT((out[5].rotations[0] - bent(0.2)).norm(), 1e-9);
  EXPECT_LT((out[3].root_position - Vec3(0.0, 1.1, 0.3)).norm(), 1e-9);
  EXPECT_LT((out[4].root_position - Vec3(0.1, 1.0, 0.3)).norm(), 1e-9);
  EXPECT_LT((out[7].root_position - Vec3(0.4, 0.9, 0.3)).norm(), 1e-9);
  EXPECT_NEAR(out[7].yaw_rad, 0.5 * kPi, 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
