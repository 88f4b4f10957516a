// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/gravity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

SensorRecording resting(const Vec3& reading, double noise = 0.0, double seconds = 3.0) {
  Random random(1);
  SensorRecording out;
  const auto n = static_cast<Eigen::Index>(seconds * 100.0);
  out.specific_force = reading.replicate(1, n) + random.matrix(3, n, noise);
  out.angular_velocity = Vec3(0.01, -0.02, 0.03).replicate(1, n);
  for (Eigen::Index i = 0; i < n; ++i) out.times_s.push_back(static_cast<double>(i) * 0.01);
  return out;
}

TEST(StandingGravity, OfASensorFlatOnATableIsOnItsAxisUp) {
  struct Row {
    Vec3 reading, up;
    double scale;
    bool is_in_g;
  };
  for (const Row& row :
       {Row{{0, 0, 9.81}, {0, 0, 1}, 1.0, false}, Row{{0, 0, 1.0}, {0, 0, 1}, 9.81, true},
        Row{{0, 0, 10.3005}, {0, 0, 1}, 1 / 1.05, false},
        Row{{-9.3195, 0, 0}, {-1, 0, 0}, 1 / 0.95, false},
        Row{{0, -1.05, 0}, {0, -1, 0}, 9.81 / 1.05, true}}) {
    const StandingGravity gravity = standing_gravity(resting(row.reading));
    EXPECT_NEAR(gravity.scale, row.scale, 1e-9);
    EXPECT_EQ(gravity.is_in_g, row.is_in_g);
    EXPECT_LT((gravity.up - row.up).norm(), 1e-9);
    EXPECT_LT((gravity.scale * row.reading - 9.81 * row.up).norm(), 1e-9);
    EXPECT_LT((gravity.gyroscope_bias - Vec3(0.01, -0.02, 0.03)).norm(), 1e-12);
  }
}

std::string refusal(const SensorRecording& recording) {
  try {
    standing_gravity(recording);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StandingGravity, RefusesWithTheMeasuredNumber) {
  for (const double wrong : {0.0, 0.84, 1.16, 5.0, 8.3, 11.3, 2048.0}) {
    const std::string told = refusal(resting({0, wrong, 0}));
    const auto at = told.find("at rest it reads ");
    ASSERT_NE(at, std::string::npos) << told;
    EXPECT_NEAR(std::stod(told.substr(at + 17)), wrong, 1e-9);
  }
  for (const double right : {0.86, 1.14, 8.35, 11.27})
    EXPECT_EQ(refusal(resting({0, right, 0})), "accepted");
}

TEST(StandingGravity, RefusesAShortStandAndAMovingOne) {
  EXPECT_NE(refusal(resting({0, 0, 9.81}, 0.0, 0.3)).find("lasts 0.29 s"), std::string::npos);
  SensorRecording moving = resting({0, 0, 9.81});
  for (Eigen::Index i = 0; i < moving.num_samples(); ++i)
    moving.specific_force(0, i) += 4.0 * std::sin(static_cast<double>(i) * 0.06);
  EXPECT_NE(refusal(moving).find("not still"), std::string::npos);
}

TEST(StandingGravity, TakesTheQuietestSecond) {
  SensorRecording shuffling = resting({0, 0, 9.81}, 0.2);
  for (Eigen::Index i = 0; i < 120; ++i)
    shuffling.specific_force.col(i) += Vec3(0.0, 4.0 * std::sin(static_cast<double>(i) * 0.1), 0.0);
  EXPECT_LT((standing_gravity(shuffling).up - Vec3::UnitZ()).norm(), 0.01);
}

}  // namespace
}  // namespace sparse_mocap
