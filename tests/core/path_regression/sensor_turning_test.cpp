// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/sensor_turning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;

constexpr Channels kTracker = Channel::specific_force | Channel::orientation;
constexpr Channels kGyroscope =
    Channel::specific_force | Channel::angular_velocity | Channel::gravity_direction;
constexpr double kStep_s = 0.04;

std::vector<Sensor> worn(Channels channels) { return {{find_site("left_wrist"), 1.0, channels}}; }

Quat random_rotation(Random& random) {
  return Quat(Eigen::Vector4d(random.column(4, 1.0)).normalized());
}

void set_orientation(const Quat& q, Reading& reading) {
  reading.orientation.col(0) << q.w(), q.x(), q.y(), q.z();
}

// Readings of a sensor that turns about one axis of its own at a changing rate: its orientation is
// start * AngleAxis(angle(t), axis).
struct Spin {
  Quat start;
  Vec3 axis;

  double angle(double t) const { return 2.0 * std::sin(1.3 * t); }
  double rate(double t) const { return 2.6 * std::cos(1.3 * t); }
  Quat at(double t) const { return start * Quat(Eigen::AngleAxisd(angle(t), axis)); }
  Reading reading(double t) const {
    Reading reading(1);
    reading.time_s = t;
    reading.angular_velocity.col(0) = rate(t) * axis;
    reading.gravity_direction.col(0) = at(t).conjugate() * kUp;
    return reading;
  }
};

Quat told(const Reading& reading) {
  return quaternion_of(Eigen::Vector4d(reading.orientation.col(0)));
}

TEST(WithTurning, AddsWhatIsWorkedOut) {
  EXPECT_EQ(with_turning(worn(kTracker), true)[0].channels,
            kTracker | Channel::gravity_direction | Channel::angular_velocity);
  EXPECT_EQ(with_turning(worn(kGyroscope), true)[0].channels, kGyroscope | Channel::orientation);
  EXPECT_EQ(with_turning(worn(kGyroscope), false)[0].channels, kGyroscope);
  EXPECT_EQ(with_turning(worn(Channel::specific_force), true)[0].channels,
            Channels(Channel::specific_force));
  EXPECT_TRUE(has_own_heading(worn(kGyroscope)[0], true));
  EXPECT_FALSE(has_own_heading(worn(kGyroscope)[0], false));
  EXPECT_FALSE(has_own_heading(worn(kGyroscope | Channel::orientation)[0], true));
}

TEST(TurningOf, SaysWhatAGyroscopeWould) {
  TurningOf turning(worn(kTracker), true);
  Reading first(1), second(1);
  set_orientation(Quat::Identity(), first);
  set_orientation(Quat(Eigen::AngleAxisd(0.1, kUp)), second);
  second.time_s = kStep_s;
  turning(first);
  const Reading& reading = turning(second);
  EXPECT_LT((reading.gravity_direction.col(0) - kUp).norm(), 1e-9);
  EXPECT_LT((reading.angular_velocity.col(0) - 0.1 / kStep_s * kUp).norm(), 1e-6);
}

TEST(TurningOf, LeavesWhatASensorMeasuresItself) {
  TurningOf turning(worn(kTracker | Channel::gravity_direction | Channel::angular_velocity), true);
  Reading measured(1);
  set_orientation(Quat::Identity(), measured);
  measured.gravity_direction.setConstant(0.5);
  measured.angular_velocity.setConstant(0.25);
  EXPECT_EQ(turning(measured).gravity_direction, measured.gravity_direction);
  EXPECT_EQ(turning(measured).angular_velocity, measured.angular_velocity);
}

// But for one turn about the vertical, which is the same all along.
TEST(TurningOf, FollowsAGyroscope) {
  Random random(3);
  for (int i = 0; i < 5; ++i) {
    const Spin spin{random_rotation(random), Vec3(random.column(3, 1.0)).normalized()};
    TurningOf turning(worn(kGyroscope), true);
    Quat own_of_world = Quat::Identity();
    for (int n = 0; n <= 100; ++n) {
      const double t = kStep_s * n;
      const Quat found = told(turning(spin.reading(t)));
      if (n == 0) own_of_world = found * spin.at(t).conjugate();
      EXPECT_LT(found.angularDistance(own_of_world * spin.at(t)), 0.01) << n;
    }
    EXPECT_LT((own_of_world * kUp - kUp).norm(), 1e-6);
  }
}

TEST(TurningOf, KeepsTheInclinationThoughTheGyroscopeIsBiased) {
  Random random(4);
  const Spin spin{random_rotation(random), Vec3::UnitX()};
  TurningOf turning(worn(kGyroscope), true);
  Reading reading = spin.reading(0.0);
  for (int n = 0; n < 250; ++n) {
    reading.time_s = kStep_s * n;
    reading.angular_velocity.col(0) = Vec3(0.05, -0.03, 0.04);
    const Quat found = told(turning(reading));
    EXPECT_LT((found * reading.gravity_direction.col(0) - kUp).norm(), 1e-6);
  }
}

TEST(TurningOf, BeginsAnewAfterASilence) {
  const Spin spin{Quat::Identity(), kUp};
  TurningOf turning(worn(kGyroscope), true);
  turning(spin.reading(0.0));
  EXPECT_GT(told(turning(spin.reading(kStep_s))).angularDistance(Quat::Identity()), 0.05);
  EXPECT_FALSE(turning(Reading(1)).orientation.allFinite());
  EXPECT_LT(told(turning(spin.reading(3 * kStep_s))).angularDistance(Quat::Identity()), 1e-6);
  EXPECT_FALSE(turning(spin.reading(1.0)).orientation.allFinite());  // a long way from the last
}

TEST(TurningOf, ForgetsWhenItIsReset) {
  const Spin spin{Quat::Identity(), kUp};
  TurningOf turning(worn(kGyroscope), true);
  turning(spin.reading(0.0));
  turning(spin.reading(kStep_s));
  turning.reset();
  EXPECT_LT(told(turning(spin.reading(0.5))).angularDistance(Quat::Identity()), 1e-6);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
