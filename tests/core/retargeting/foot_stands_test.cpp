// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/foot_stands.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sparse_mocap {
namespace {

constexpr double kAnkle_m = 0.08, kFrame_s = 0.02;

// Half a second each: stands and slides slowly, swings 0.4 m, stands and slides, swings.
Eigen::Matrix3Xd steps() {
  Eigen::Matrix3Xd path(3, 100);
  double z = 0.0;
  for (int t = 0; t < 100; ++t) {
    const bool swings = (t / 25) % 2 == 1;
    const double phase = (t % 25) / 25.0;
    z += swings ? 0.4 / 25.0 : 0.002;
    path.col(t) = Vec3(0.1, kAnkle_m + 0.01 + (swings ? 0.15 * std::sin(kPi * phase) : 0.0), z);
  }
  return path;
}

std::vector<Stand> stands_of(const Eigen::Matrix3Xd& path, const Eigen::VectorXd& certainty) {
  return find_stands(path, certainty, kAnkle_m, kFrame_s, {});
}

TEST(FootStands, AreFoundWhereAFootIsLowSlowAndCertain) {
  const auto stands = stands_of(steps(), Eigen::VectorXd::Ones(100));
  ASSERT_EQ(stands.size(), 2u);
  EXPECT_NEAR(stands[0].begin, 0, 1);
  EXPECT_NEAR(stands[0].end, 25, 1);
  EXPECT_NEAR(stands[1].begin, 50, 1);
  EXPECT_NEAR(stands[1].end, 75, 1);
  EXPECT_TRUE(stands_of(steps(), Eigen::VectorXd::Constant(100, 0.4)).empty());
}

TEST(FootStands, CloseShortGapsAndDropShortStands) {
  Eigen::VectorXd certainty = Eigen::VectorXd::Ones(100);
  certainty.segment(10, 3).setZero();  // 0.06 s
  EXPECT_EQ(stands_of(steps(), certainty).size(), 2u);
  certainty.segment(10, 6).setZero();
  EXPECT_EQ(stands_of(steps(), certainty).size(), 3u);
  certainty.setZero();
  certainty.segment(5, 4).setOnes();  // 0.08 s
  EXPECT_TRUE(stands_of(steps(), certainty).empty());
}

TEST(FootStands, HoldTheFootAndPassSmoothlyFromOneToTheNext) {
  const Eigen::Matrix3Xd path = steps();
  const auto stands = stands_of(path, Eigen::VectorXd::Ones(100));
  const Eigen::Matrix3Xd held = path + stand_corrections(path, stands, kAnkle_m);
  for (const Stand& stand : stands) {
    for (int t = stand.begin; t < stand.end; ++t) {
      EXPECT_LT((held.col(t) - held.col(stand.begin)).norm(), 1e-12);
      EXPECT_NEAR(held(1, t), kAnkle_m, 1e-12);
    }
  }
  const Eigen::Matrix3Xd added = held - path;
  for (int t = 1; t < 100; ++t) EXPECT_LT((added.col(t) - added.col(t - 1)).norm(), 0.006) << t;
  EXPECT_TRUE(stand_corrections(path, {}, kAnkle_m).isZero());
}

TEST(FootStands, WeighOneInsideAndZeroFarAway) {
  const Eigen::VectorXd weights = stand_weights({{20, 30}}, 60, 8.0);
  for (int t = 20; t < 30; ++t) EXPECT_DOUBLE_EQ(weights[t], 1.0);
  EXPECT_DOUBLE_EQ(weights[10], 0.0);
  EXPECT_DOUBLE_EQ(weights[40], 0.0);
  for (int t = 31; t < 38; ++t) EXPECT_LT(weights[t], weights[t - 1]);
  EXPECT_NEAR(weights[16], weights[33], 1e-12);
}

}  // namespace
}  // namespace sparse_mocap
