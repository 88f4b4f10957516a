// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/root_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

constexpr double kDt = 0.04;

RootRates rates(double left_mps, double forward_mps, double yaw_rate_radps, double height_m) {
  RootRates out;
  out.velocity_mps = {left_mps, forward_mps};
  out.yaw_rate_radps = yaw_rate_radps;
  out.height_m = height_m;
  return out;
}

TEST(RootTracker, StartsAtTheOriginAndTakesItsHeightAtOnce) {
  RootTracker tracker(kDt);
  tracker.advance(rates(3.0, 4.0, 1.0, 0.9));
  EXPECT_EQ(tracker.position(), Vec3(0, 0.9, 0));
  EXPECT_EQ(tracker.yaw_rad(), 0.0);
}

// Forward at v while turning at w: a circle of radius v / w to the left, closed after 2 pi / w.
TEST(RootTracker, WalksACircle) {
  const double v = 1.2;
  const int steps = 500;
  const double w = 2.0 * kPi / (steps * kDt);
  RootTracker tracker(kDt);
  tracker.advance(rates(0, v, w, 0.9));
  for (int t = 1; t <= steps; ++t) {
    tracker.advance(rates(0, v, w, 0.9));
    const double angle = w * t * kDt;
    EXPECT_NEAR(tracker.yaw_rad(), angle, 1e-9);
    const Vec3 expected(v / w * (1.0 - std::cos(angle)), 0.9, v / w * std::sin(angle));
    EXPECT_LT((tracker.position() - expected).norm(), 1.01 * v * kDt);  // it leads by half a step
  }
  EXPECT_LT((tracker.position() - Vec3(0, 0.9, 0)).norm(), 1e-9);
}

TEST(RootTracker, StepsToTheLeftOfWhereItFaces) {
  RootTracker tracker(kDt);
  tracker.advance(rates(0, 0, 0, 0.9));
  tracker.advance(rates(1.0, 0, 0, 0.9));
  EXPECT_LT((tracker.position() - Vec3(kDt, 0.9, 0)).norm(), 1e-12);
}

TEST(RootTracker, BeginsAnewAfterAReset) {
  RootTracker tracker(kDt);
  for (int t = 0; t < 5; ++t) tracker.advance(rates(1, 1, 1, 0.8));
  tracker.reset();
  EXPECT_EQ(tracker.position(), Vec3::Zero());
  EXPECT_EQ(tracker.yaw_rad(), 0.0);
  tracker.advance(rates(1, 1, 1, 0.7));
  EXPECT_EQ(tracker.position(), Vec3(0, 0.7, 0));
}

TEST(RootRatesOf, NeighboursAreTheirWeightedMeans) {
  using namespace root_motion_column;
  DatabaseContent content = testing::content_of(
      {testing::swaying_motion(testing::template_skeleton(), 1, 10, 25.0)}, 25.0);
  testing::change_rows(content, 0, [](DatabaseRows& rows) {
    for (int n = 0; n < 10; ++n) {
      const auto x = static_cast<float>(n);
      rows.root_motion.row(n) << 0.1F * x, 1.0F + x, -0.5F * x, 0.9F;
      rows.contacts.row(n) << (n < 5 ? 1.0F : 0.0F), 1.0F;
    }
  });
  const auto database = testing::database_of(content);
  Neighbourhood neighbours;
  neighbours.paths = {{2, 1.0, 1, -1}, {4, 1.0, 1, -1}, {8, 1.0, 1, -1}};
  neighbours.weights = Eigen::Vector3d(0.5, 0.25, 0.25);
  const RootRates found = root_rates(*database, neighbours);
  EXPECT_NEAR(found.velocity_mps.x(), 0.4, 1e-6);
  EXPECT_NEAR(found.velocity_mps.y(), 5.0, 1e-6);
  EXPECT_NEAR(found.yaw_rate_radps, -2.0, 1e-6);
  EXPECT_NEAR(found.height_m, 0.9, 1e-6);
  EXPECT_LT((found.contacts - Eigen::Vector2d(0.75, 1.0)).norm(), 1e-6);
}

}  // namespace
}  // namespace sparse_mocap::retrieval
