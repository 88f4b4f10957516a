// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/pose_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sparse_mocap {
namespace {

constexpr double kDt = 0.04, kLag_s = 0.2;
const Vec3 kAxis = Vec3(1.0, 2.0, -0.5).normalized();

PoseEstimate turned_by(double angle, double height_m = 0.9) {
  PoseEstimate estimate;
  estimate.rotations = {Quat::Identity(), Quat(Eigen::AngleAxisd(angle, kAxis))};
  estimate.root_position = Vec3(3.0, height_m, -2.0);
  return estimate;
}

double angle_of(const PoseEstimate& estimate) {
  const Eigen::AngleAxisd turn(estimate.rotations[1]);
  return turn.angle() * turn.axis().dot(kAxis);
}

// x'' = -(4 / lag) x' - (2 / lag)^2 (x - wanted), in steps of a millisecond.
struct Spring {
  double x = 0.0, v = 0.0;
  void go_on(double wanted) {
    constexpr int kSteps = 40'000;
    const double rate = 2.0 / kLag_s, dt = kDt / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      v += dt * (-2.0 * rate * v - rate * rate * (x - wanted));
      x += dt * v;
    }
  }
};

TEST(PoseFollower, FollowsLikeASpring) {
  PoseFollower follower(kLag_s, kDt);
  Spring angle, height{0.9, 0.0};
  PoseEstimate first = turned_by(0.0);
  follower.apply(first);
  for (int t = 0; t < 30; ++t) {
    const double wanted = t < 12 ? 2.5 : -0.4, high = t < 20 ? 1.0 : 0.3;
    PoseEstimate estimate = turned_by(wanted, high);
    follower.apply(estimate);
    angle.go_on(wanted);
    height.go_on(high);
    EXPECT_NEAR(angle_of(estimate), angle.x, 1e-4) << t;
    EXPECT_NEAR(estimate.root_position.y(), height.x, 1e-4) << t;
    EXPECT_EQ(estimate.root_position.x(), 3.0);
    EXPECT_LT(estimate.rotations[0].angularDistance(Quat::Identity()), 1e-12);
  }
}

TEST(PoseFollower, LagsBehindASteadyTurn) {
  constexpr double kRate = 1.5;
  PoseFollower follower(kLag_s, kDt);
  double lag = 0.0;
  for (int t = 0; t < 60; ++t) {
    PoseEstimate estimate = turned_by(kRate * kDt * t);
    follower.apply(estimate);
    lag = std::remainder(kRate * kDt * t - angle_of(estimate), 2.0 * kPi);
  }
  // A frame's pose is held until the next, so it is half a frame old on average.
  EXPECT_NEAR(lag, kRate * (kLag_s - 0.5 * kDt), 0.1 * kDt * kRate);
}

TEST(PoseFollower, IsAtRestAfterAResetAndWithoutALag) {
  PoseFollower follower(kLag_s, kDt), none(0.0, kDt);
  for (const double wanted : {0.0, 2.0, -1.0}) {
    PoseEstimate estimate = turned_by(wanted), same = estimate;
    follower.reset();
    follower.apply(estimate);
    none.apply(same);
    EXPECT_EQ(estimate.rotations[1].coeffs(), turned_by(wanted).rotations[1].coeffs());
    EXPECT_EQ(same.rotations[1].coeffs(), turned_by(wanted).rotations[1].coeffs());
  }
}

}  // namespace
}  // namespace sparse_mocap
