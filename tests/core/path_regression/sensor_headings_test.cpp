// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/sensor_headings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/common_yaw.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;

constexpr double kRate_hz = 25.0;

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

Quat random_rotation(Random& random) {
  return Quat(Eigen::Vector4d(random.column(4, 1.0)).normalized());
}

// Four sensors of a performer who turns about; each heading is off by what off(sensor, t) says.
struct Performance {
  std::vector<Reading> readings;
  std::vector<std::vector<Mat3>> posed;  // R_heading_sensor
  std::vector<std::vector<HeadingHint>> hints;

  Performance(int num_readings, double pose_error, const std::function<double(int, double)>& off) {
    Random random(5);
    for (int n = 0; n < num_readings; ++n) {
      const double t = n / kRate_hz, heading_rad = 0.7 * t + std::sin(t);
      Reading reading(4);
      reading.time_s = t;
      std::vector<Mat3> R(4);
      for (int s = 0; s < 4; ++s) {
        R[static_cast<std::size_t>(s)] = random_rotation(random).toRotationMatrix();
        const Quat q(yaw_rotation(heading_rad - off(s, t)) * R[static_cast<std::size_t>(s)]);
        reading.orientation.col(s) << q.w(), q.x(), q.y(), q.z();
        const Vec3 wrong = random.column(3, pose_error);
        R[static_cast<std::size_t>(s)] =
            Eigen::AngleAxisd(wrong.norm(), wrong.normalized()) * R[static_cast<std::size_t>(s)];
      }
      hints.emplace_back();
      put_heading_hints(reading, R, hints.back());
      readings.push_back(reading);
      posed.push_back(R);
    }
  }
};

HeadingSettings all_own(double memory_s = 20.0) {
  HeadingSettings settings;
  settings.is_own.assign(4, true);
  settings.rate_hz = kRate_hz;
  settings.memory_s = memory_s;
  return settings;
}

// Offsets are right when they bring all sensors to one heading, whichever.
double worst_rad(std::span<const double> found, const std::function<double(int)>& wanted) {
  double worst = 0.0;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b)
      worst = std::max(worst, std::abs(wrapped(found[static_cast<std::size_t>(a)] - wanted(a) -
                                               found[static_cast<std::size_t>(b)] + wanted(b))));
  return worst;
}

double constant_off(int sensor, double) { return 1.9 * sensor - 2.5; }

TEST(HeadingHint, IsTheTurnThatBringsAnOrientationNearestToThePose) {
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const Quat measured = random_rotation(random);
    const Mat3 posed = random_rotation(random).toRotationMatrix();
    const std::vector<Mat3> a{posed}, b{measured.toRotationMatrix()};
    const HeadingHint hint = heading_hint(
        Eigen::Vector4d(measured.w(), measured.x(), measured.y(), measured.z()), posed);
    EXPECT_NEAR(wrapped(std::arg(hint.turn) - common_yaw_rad(a, b)), 0.0, 1e-9);
    EXPECT_LE(std::abs(hint.turn), 2.0 + 1e-9);
  }
  EXPECT_FALSE(heading_hint(Eigen::Vector4d::Constant(std::nan("")), Mat3::Identity()).is_heard);
}

TEST(SensorHeadings, AreFoundFromRightPoses) {
  const Performance performance(25, 0.0, constant_off);
  SensorHeadings headings(all_own());
  EXPECT_TRUE(std::isnan(headings.offsets_rad()[0]));
  double heading_rad = 0.0, before_rad = 0.0;
  for (std::size_t t = 0; t < performance.hints.size(); ++t) {
    before_rad = std::exchange(heading_rad, headings.observe(performance.hints[t]));
    EXPECT_TRUE(t >= 6 || std::isnan(headings.offsets_rad()[2])) << t;
  }
  EXPECT_LT(worst_rad(headings.offsets_rad(), [](int s) { return constant_off(s, 0.0); }), 1e-6);
  const double t = 24 / kRate_hz, turned_rad = 0.7 / kRate_hz + std::sin(t) - std::sin(t - 0.04);
  EXPECT_NEAR(wrapped(heading_rad - before_rad), -turned_rad, 1e-6);
}

TEST(SensorHeadings, AreFoundInTheMeanOfWrongPoses) {
  const Performance performance(1000, 0.5, constant_off);
  SensorHeadings headings(all_own());
  for (const auto& hints : performance.hints) headings.observe(hints);
  EXPECT_LT(worst_rad(headings.offsets_rad(), [](int s) { return constant_off(s, 0.0); }), 0.12);
}

TEST(SensorHeadings, FollowADrift) {
  const auto drifting = [](int s, double t) { return constant_off(s, 0.0) + 0.02 * s * t; };
  const Performance performance(2500, 0.0, drifting);
  SensorHeadings headings(all_own(5.0));
  for (const auto& hints : performance.hints) headings.observe(hints);
  const auto now = [&](int s) { return drifting(s, 99.96); };
  EXPECT_LT(worst_rad(headings.offsets_rad(), now), 0.35);  // 5 s late
  const auto offsets = whole_take_offsets(all_own(5.0), performance.hints);
  EXPECT_LT(worst_rad(offsets[1250], [&](int s) { return drifting(s, 50.0); }), 0.01);
}

HeadingSettings trackers_but_one() {
  HeadingSettings settings = all_own();
  settings.is_own = {false, false, false, true};
  return settings;
}

TEST(SensorHeadings, OfTrackersAreLeftAloneWhereStyleMayBeTheReason) {
  const auto off = [](int s, double) { return s == 3 ? 1.1 : 0.03 * s; };
  const Performance performance(3000, 0.0, off);
  SensorHeadings headings(trackers_but_one());
  for (const auto& hints : performance.hints) {
    headings.observe(hints);
    for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(headings.offsets_rad()[s], 0.0);
  }
  EXPECT_NEAR(headings.offsets_rad()[3], 1.1, 0.05);
  for (const auto& offsets : whole_take_offsets(trackers_but_one(), performance.hints))
    for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(offsets[s], 0.0);
}

TEST(SensorHeadings, OfTrackersAreTurnedBackWhenTheyDrift) {
  const auto off = [](int s, double t) { return s == 1 ? 0.005 * t : 0.0; };  // 0.9 in the end
  const Performance performance(4500, 0.3, off);
  HeadingSettings settings = all_own();
  settings.is_own.assign(4, false);
  SensorHeadings headings(settings);
  for (const auto& hints : performance.hints) headings.observe(hints);
  const auto at_end = [](int s) { return s == 1 ? 0.9 : 0.0; };
  EXPECT_LT(worst_rad(headings.offsets_rad(), at_end), 0.55);  // 20 s late, and the style's part
  const auto offsets = whole_take_offsets(settings, performance.hints);
  EXPECT_LT(worst_rad(offsets.back(), at_end), 0.55);
  EXPECT_LT(worst_rad(offsets[3000], [](int s) { return s == 1 ? 0.6 : 0.0; }), 0.4);
  EXPECT_EQ(offsets.front()[1], 0.0);
}

TEST(SensorHeadings, OfASilentSensorAreFoundAnew) {
  Performance performance(100, 0.0, [](int s, double t) {
    return constant_off(s, 0.0) + (s == 1 && t > 2.0 ? 0.8 : 0.0);
  });
  for (std::size_t t = 45; t < 51; ++t) performance.hints[t][1] = {};
  SensorHeadings headings(all_own());
  for (std::size_t t = 0; t < 51; ++t) headings.observe(performance.hints[t]);
  EXPECT_TRUE(std::isnan(headings.offsets_rad()[1]));
  EXPECT_FALSE(std::isnan(headings.offsets_rad()[0]));  // the others do without it
  headings.observe(performance.hints[51]);
  EXPECT_TRUE(std::isnan(headings.offsets_rad()[0]));  // until it is known again
  for (std::size_t t = 52; t < 100; ++t) headings.observe(performance.hints[t]);
  const auto wanted = [](int s) { return constant_off(s, 0.0) + (s == 1 ? 0.8 : 0.0); };
  EXPECT_LT(worst_rad(headings.offsets_rad(), wanted), 1e-6);
  const auto offsets = whole_take_offsets(all_own(), performance.hints);
  EXPECT_LT(worst_rad(offsets[51], wanted), 1e-6);
  EXPECT_LT(worst_rad(offsets[44], [](int s) { return constant_off(s, 0.0); }), 1e-6);
  EXPECT_TRUE(std::isnan(offsets[48][1]));
}

TEST(WholeTakeOffsets, AreNearerThanThoseFromThePastAlone) {
  const Performance performance(250, 0.6, constant_off);
  const auto wanted = [](int s) { return constant_off(s, 0.0); };
  SensorHeadings headings(all_own());
  double live = 0.0, whole = 0.0;
  const auto offsets = whole_take_offsets(all_own(), performance.hints);
  for (std::size_t t = 0; t < performance.hints.size(); ++t) {
    headings.observe(performance.hints[t]);
    if (t < 50) continue;
    live += worst_rad(headings.offsets_rad(), wanted);
    whole += worst_rad(offsets[t], wanted);
  }
  EXPECT_LT(whole, 0.8 * live);
  EXPECT_LT(whole / 200.0, 0.2);
}

TEST(WholeTakeOffsets, DoWithHintsHereAndThere) {
  Performance performance(600, 0.3, constant_off);
  for (std::size_t t = 0; t < 600; ++t)
    if (t / 100 % 3 != 0) put_no_hints(performance.readings[t], performance.hints[t]);
  const auto offsets = whole_take_offsets(all_own(), performance.hints);
  for (std::size_t t = 0; t < 600; ++t)
    EXPECT_LT(worst_rad(offsets[t], [](int s) { return constant_off(s, 0.0); }), 0.15) << t;
  Reading silent(2);
  silent.orientation.col(1) << 1.0, 0.0, 0.0, 0.0;
  std::vector<HeadingHint> hints;
  put_no_hints(silent, hints);
  EXPECT_FALSE(hints[0].is_heard);
  EXPECT_TRUE(hints[1].is_heard);
  EXPECT_EQ(hints[1].turn, 0.0);
}

TEST(WholeTakeOffsets, OfAMomentAreUnknown) {
  const Performance performance(3, 0.0, constant_off);
  for (const auto& of_reading : whole_take_offsets(all_own(), performance.hints))
    for (const double offset : of_reading) EXPECT_TRUE(std::isnan(offset));
  EXPECT_TRUE(whole_take_offsets(all_own(), {}).empty());
}

TEST(TurnHeadings, BringsAllToOneHeading) {
  const Performance performance(1, 0.0, constant_off);
  Reading reading = performance.readings[0];
  std::vector<double> offsets;
  for (int s = 0; s < 4; ++s) offsets.push_back(constant_off(s, 0.0));
  turn_headings(offsets, reading);
  for (int s = 0; s < 4; ++s)
    EXPECT_LT((quaternion_of(Eigen::Vector4d(reading.orientation.col(s))).toRotationMatrix() -
               performance.posed[0][static_cast<std::size_t>(s)])
                  .norm(),
              1e-6);
  offsets[2] = std::nan("");
  turn_headings(offsets, reading);
  EXPECT_FALSE(reading.orientation.col(2).allFinite());
  EXPECT_TRUE(reading.orientation.col(1).allFinite());
}

}  // namespace
}  // namespace sparse_mocap::path_regression
