// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/baselines.hpp"

#include <gtest/gtest.h>

#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

// Three clips of four frames; in frame n every sensor reads value[n] on all axes, and every joint
// lies at 10 value[n] on all axes.
class Baselines : public ::testing::Test {
 protected:
  Baselines() {
    const Motion still = testing::resting_motion(testing::template_skeleton(), 4, 25.0);
    DatabaseContent content = testing::content_of({still, still, still}, 25.0);
    for (std::size_t clip = 0; clip < 3; ++clip)
      testing::change_rows(content, clip, [&](DatabaseRows& rows) {
        for (Eigen::Index row = 0; row < 4; ++row) {
          const float value = kValue[4 * clip + static_cast<std::size_t>(row)];
          rows.specific_force_end.row(row).setConstant(value);
          rows.specific_force_pivot.row(row).setConstant(-100.0F);
          rows.positions.row(row).setConstant(10.0F * value);
        }
      });
    database_ = testing::database_of(content);
  }

  static std::vector<Reading> take(const std::vector<double>& values) {
    std::vector<Reading> readings;
    for (const double value : values) {
      readings.emplace_back(2);
      readings.back().specific_force.setConstant(value);
    }
    return readings;
  }

  static constexpr float kValue[] = {0, 1, 2, 3, 2, 1, 0, 5, 1, 1, 3, 3};
  const std::vector<Sensor> sensors_{{0, 1.0}, {3, 1.0}};
  std::shared_ptr<const MotionDatabase> database_;
};

TEST_F(Baselines, NearestWindowOfOneReadingIsTheNearestReading) {
  EXPECT_EQ(nearest_windows(*database_, sensors_, take({0.1, 0.9, 2.2, 3.1, 4.9}), 1, {}),
            (std::vector<int>{0, 1, 2, 3, 7}));
}

// After 2 the reading 1 is that of the second clip, after 0 that of the first.
TEST_F(Baselines, NearestWindowTellsApartWhatCameBefore) {
  EXPECT_EQ(nearest_windows(*database_, sensors_, take({2, 1}), 2, {})[1], 5);
  EXPECT_EQ(nearest_windows(*database_, sensors_, take({0, 1}), 2, {})[1], 1);
  EXPECT_EQ(nearest_windows(*database_, sensors_, take({1, 1}), 2, {})[1], 8);
}

TEST_F(Baselines, PlaybackFollowsTheBestPath) {
  EXPECT_EQ(playback_best_path(*database_, sensors_, take({0, 1, 2, 3}), {}),
            (std::vector<int>{0, 1, 2, 3}));
  const auto falling = playback_best_path(*database_, sensors_, take({2, 1, 0}), {});
  EXPECT_EQ(falling[1], 5);
  EXPECT_EQ(falling[2], 6);
}

TEST_F(Baselines, NearestPoseLooksAtPositionsOnly) {
  Eigen::MatrixXd truth(63, 3);
  truth.col(0).setConstant(9.0);
  truth.col(1).setConstant(51.0);
  truth.col(2).setConstant(29.0);
  EXPECT_EQ(nearest_poses(*database_, truth, {}), (std::vector<int>{1, 7, 3}));
}

TEST_F(Baselines, NeverUseExcludedClips) {
  const auto expect_outside_first = [](const std::vector<int>& frames) {
    for (const int frame : frames) EXPECT_GE(frame, 4);
  };
  expect_outside_first(nearest_windows(*database_, sensors_, take({0, 1, 2, 3}), 2, {0}));
  expect_outside_first(playback_best_path(*database_, sensors_, take({0, 1, 2, 3}), {0}));
  Eigen::MatrixXd truth = Eigen::MatrixXd::Constant(63, 1, 10.0);
  expect_outside_first(nearest_poses(*database_, truth, {0}));
}

}  // namespace
}  // namespace sparse_mocap
