// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/two_bone_ik.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sparse_mocap {
namespace {

// A leg that hangs down with its knee bent forward (+z), x to the left.
TwoBoneLimb bent_leg(double bend_rad) {
  TwoBoneLimb limb;
  limb.begin = {0.1, 1.0, 0.0};
  const Mat3 thigh(Eigen::AngleAxisd(-bend_rad, Vec3::UnitX()));
  const Mat3 shank(Eigen::AngleAxisd(bend_rad, Vec3::UnitX()));
  limb.R_upper = thigh;
  limb.R_lower = shank;
  limb.middle = limb.begin + thigh * Vec3(0.0, -0.4, 0.0);
  limb.end = limb.middle + shank * Vec3(0.0, -0.45, 0.0);
  return limb;
}

double forward_of_line(const TwoBoneLimb& limb) {
  const Vec3 along = (limb.end - limb.begin).normalized();
  const Vec3 knee = limb.middle - limb.begin;
  return (knee - along * along.dot(knee)).z();
}

TEST(TwoBoneIk, GetsToWhereverItsLengthAllows) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> far(-0.5, 0.5);
  for (int i = 0; i < 200; ++i) {
    TwoBoneLimb limb = bent_leg(0.4);
    const TwoBoneLimb before = limb;
    const Vec3 target = limb.begin + Vec3(far(random), -0.5 + 0.3 * far(random), far(random));
    reach(target, Vec3::UnitX(), limb);
    const double short_of_it = std::max(0.0, (target - limb.begin).norm() - 0.9995 * 0.85);
    EXPECT_NEAR((limb.end - target).norm(), short_of_it, 1e-9);
    EXPECT_NEAR((limb.middle - limb.begin).norm(), 0.4, 1e-12);
    EXPECT_NEAR((limb.end - limb.middle).norm(), 0.45, 1e-12);
    // The rotations carry the bones that they carried before.
    const Vec3 upper = before.R_upper.transpose() * (before.middle - before.begin);
    const Vec3 lower = before.R_lower.transpose() * (before.end - before.middle);
    EXPECT_LT((limb.R_upper * upper - (limb.middle - limb.begin)).norm(), 1e-9);
    EXPECT_LT((limb.R_lower * lower - (limb.end - limb.middle)).norm(), 1e-9);
    EXPECT_NEAR(limb.R_upper.determinant(), 1.0, 1e-9);
  }
}

TEST(TwoBoneIk, StaysWhereItIsWhenItIsThere) {
  TwoBoneLimb limb = bent_leg(0.3);
  const TwoBoneLimb before = limb;
  reach(limb.end, Vec3::UnitX(), limb);
  EXPECT_LT((limb.middle - before.middle).norm(), 1e-9);
  EXPECT_LT((limb.R_upper - before.R_upper).norm(), 1e-9);
  EXPECT_LT((limb.R_lower - before.R_lower).norm(), 1e-9);
}

TEST(TwoBoneIk, BendsForwardAlsoFromStraight) {
  for (const double bend : {0.0, 0.001, 0.02, 0.5}) {
    TwoBoneLimb limb = bent_leg(bend);
    reach(limb.begin + Vec3(0.0, -0.6, 0.1), Vec3::UnitX(), limb);
    EXPECT_GT(forward_of_line(limb), 0.2) << bend;
  }
}

TEST(TwoBoneIk, PointsToWhatIsTooFar) {
  TwoBoneLimb limb = bent_leg(0.3);
  const Vec3 target = limb.begin + Vec3(0.0, -2.0, 0.5);
  reach(target, Vec3::UnitX(), limb);
  EXPECT_GT((limb.end - limb.begin).norm(), 0.99 * 0.85);
  EXPECT_GT((limb.end - limb.begin).normalized().dot((target - limb.begin).normalized()),
            1.0 - 1e-9);
}

}  // namespace
}  // namespace sparse_mocap
