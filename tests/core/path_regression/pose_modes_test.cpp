// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/pose_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;
using Choice = std::vector<std::optional<std::size_t>>;

constexpr double kFrame_s = 0.04;
constexpr Eigen::Index kJoints = 21;

// A pose all of whose joints are moved by so much along x.
Eigen::VectorXf pose_at(double x_m) {
  Eigen::VectorXf pose = Eigen::VectorXf::Zero(3 * kJoints);
  for (Eigen::Index j = 0; j < kJoints; ++j) pose[3 * j] = static_cast<float>(x_m);
  return pose;
}

FrameModes frame_of(double known_share, const std::vector<std::pair<double, double>>& modes) {
  FrameModes frame;
  frame.known_share = known_share;
  for (const auto& [x_m, share] : modes) frame.modes.push_back({pose_at(x_m), share});
  return frame;
}

Choice chosen(const std::vector<FrameModes>& frames) { return likeliest_modes(frames, kFrame_s); }

std::size_t num_away(const Choice& choice) {
  std::size_t count = 0;
  for (const auto& mode : choice) count += mode.has_value() ? 1U : 0U;
  return count;
}

TEST(PoseDistance, IsTheMeanOverTheJoints) {
  Eigen::VectorXf a = Eigen::VectorXf::Zero(6), b = Eigen::VectorXf::Zero(6);
  b << 0.3F, 0.0F, 0.4F, 0.0F, 0.1F, 0.0F;
  EXPECT_NEAR(pose_distance_m(a, b), 0.5 * (0.5 + 0.1), 1e-6);
  EXPECT_TRUE(is_alike(pose_at(0.11), std::vector{pose_at(1.0), pose_at(0.0)}));
  EXPECT_FALSE(is_alike(pose_at(0.13), std::vector{pose_at(1.0), pose_at(0.0)}));
}

TEST(PoseModes, AreWhereWeightsGatherAwayFromWhatIsKnown) {
  Random random(1);
  const std::vector<std::pair<double, double>> groups{
      {0.0, 0.5}, {0.5, 0.1}, {-0.6, 0.3}, {1.2, 0.1}};  // place and weight
  constexpr Eigen::Index kEach = 25;
  Eigen::MatrixXf positions(3 * kJoints, 4 * kEach);
  Eigen::VectorXd weights(4 * kEach);
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const auto& [x_m, weight] = groups[static_cast<std::size_t>(i % 4)];
    positions.col(i) = pose_at(x_m) + random.matrix(3 * kJoints, 1, 0.02).col(0).cast<float>();
    weights[i] = weight / kEach;
  }
  const FrameModes found = modes_of(positions, weights, std::vector{pose_at(0.03), pose_at(1.2)});
  EXPECT_NEAR(found.known_share, 0.5, 1e-5);
  ASSERT_EQ(found.modes.size(), 2U);
  EXPECT_NEAR(found.modes[0].share, 0.3, 1e-5);
  EXPECT_LT(pose_distance_m(found.modes[0].positions, pose_at(-0.6)), 0.02);
  EXPECT_NEAR(found.modes[1].share, 0.1, 1e-5);
  EXPECT_LT(pose_distance_m(found.modes[1].positions, pose_at(0.5)), 0.02);
}

TEST(PoseModes, AreNoneWhereAllIsKnown) {
  const Eigen::MatrixXf positions = pose_at(0.0).replicate(1, 5);
  const auto found =
      modes_of(positions, Eigen::VectorXd::Constant(5, 0.2), std::vector{pose_at(0.05)});
  EXPECT_TRUE(found.modes.empty());
  EXPECT_NEAR(found.known_share, 1.0, 1e-6);
  EXPECT_TRUE(modes_of({}, {}, std::vector{pose_at(0.0)}).modes.empty());
}

TEST(LikeliestModes, AreThoseOfTheBestOfAllChoices) {
  Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<FrameModes> frames;
    for (int t = 0; t < 6; ++t)
      frames.push_back(
          frame_of(random.in(0.2, 0.9), {{random.in(0.3, 0.4), random.in(0.01, 0.4)},
                                         {random.in(0.3, 0.6), random.in(0.01, 0.4)}}));
    double best = -1e9;
    for (int code = 0; code < 729; ++code) {
      Choice choice;
      for (int t = 0, rest = code; t < 6; ++t, rest /= 3)
        choice.push_back(rest % 3 == 0 ? std::nullopt
                                       : std::optional(static_cast<std::size_t>(rest % 3 - 1)));
      best = std::max(best, likelihood(frames, choice, kFrame_s));
    }
    EXPECT_NEAR(likelihood(frames, chosen(frames), kFrame_s), best, 1e-9);
  }
  EXPECT_TRUE(chosen({}).empty());
}

TEST(LikeliestModes, LeaveTheKnownMotionForLongEnoughOnly) {
  for (const auto& [length, expected] : {std::pair{2U, 0U}, {20U, 20U}}) {
    std::vector<FrameModes> frames(40, frame_of(0.9, {}));
    for (std::size_t t = 10; t < 10 + length; ++t) frames[t] = frame_of(0.5, {{0.4, 0.3}});
    EXPECT_EQ(num_away(chosen(frames)), expected);
  }
}

TEST(LikeliestModes, AreNotThoseOfLittleWeight) {
  EXPECT_EQ(num_away(chosen(std::vector(40, frame_of(0.9, {{0.4, 0.04}})))), 0U);
  EXPECT_EQ(num_away(chosen(std::vector(40, frame_of(0.7, {{0.4, 0.15}})))), 40U);
}

TEST(LikeliestModes, StayWithOneMotion) {
  // Two motions that take turns in weighing more, too far apart for anybody to jump.
  std::vector<FrameModes> frames;
  for (int t = 0; t < 40; ++t) {
    const double a = t % 2 == 0 ? 0.3 : 0.25;
    frames.push_back(frame_of(0.4, {{0.5, a}, {-0.5, 0.55 - a}}));
  }
  const Choice choice = chosen(frames);
  for (const auto& mode : choice) EXPECT_EQ(mode, choice.front());
  EXPECT_TRUE(choice.front().has_value());
}

}  // namespace
}  // namespace sparse_mocap::path_regression
