// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/heading_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kRate_hz = 30.0;

TEST(EomHeadingRate, IsTheTurningAboutTheVerticalHoweverTheSensorSits) {
  const Quat R_world_sensor = Quat(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()));
  Reading reading(1);
  reading.angular_velocity.col(0) = R_world_sensor.inverse() * Vec3(2.0, 0.4, -1.0);
  EXPECT_TRUE(std::isnan(turning_rate(reading)));
  reading.gravity_direction.col(0) = R_world_sensor.inverse() * kUp;
  EXPECT_NEAR(turning_rate(reading), 0.4, 1e-12);
}

// A body that turns by 0.5 rad/s while its leg swings about the vertical as well; the model knows a
// straight walk whose pelvis turns to and fro.
TEST(EomHeadingRate, TheBodyTurnsAsFastAsMeasuredAndSwingsAsInTheModel) {
  const Eigen::Index n = 180;
  Eigen::VectorXd modelled(n), measured(n);
  for (Eigen::Index t = 0; t < n; ++t) {
    const double cycle = 2.0 * kPi * static_cast<double>(t) / kRate_hz / 1.1;
    modelled[t] = 0.3 * std::sin(cycle);
    measured[t] = 0.5 + 1.5 * std::cos(cycle);
  }
  measured[40] = std::nan("");
  const Eigen::VectorXd found = turned_as_measured(modelled, measured, kRate_hz);
  for (Eigen::Index t = 45; t < n - 45; ++t) EXPECT_NEAR(found[t], 0.5 + modelled[t], 0.06) << t;
}

TEST(EomHeadingRate, StaysAsModelledWhereNothingIsMeasured) {
  const Eigen::VectorXd modelled = Eigen::VectorXd::LinSpaced(60, 0.0, 1.0);
  const Eigen::VectorXd unknown = Eigen::VectorXd::Constant(60, std::nan(""));
  EXPECT_EQ(turned_as_measured(modelled, unknown, kRate_hz), modelled);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
