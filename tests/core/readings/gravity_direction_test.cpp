// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/gravity_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sparse_mocap {
namespace {

constexpr double kRate_hz = 100.0;

// A sensor that is turned by hand and shaken on the way; its orientation is known in closed form:
// R(t) = R_z(a sin t) R_x(b sin 2t), whose body rates follow by hand.
struct Moved {
  SensorRecording recording;
  Eigen::Matrix3Xd up;  // what is to be found
};

Moved moved(double seconds, double shaken_mps2, const Vec3& bias = Vec3::Zero()) {
  const auto count = static_cast<Eigen::Index>(seconds * kRate_hz);
  Moved out;
  out.recording.specific_force.resize(3, count);
  out.recording.angular_velocity.resize(3, count);
  out.up.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    const double z = 1.2 * std::sin(t), x = 0.9 * std::sin(2.0 * t);
    const Mat3 R_world_sensor =
        (Eigen::AngleAxisd(z, Vec3::UnitZ()) * Eigen::AngleAxisd(x, Vec3::UnitX()))
            .toRotationMatrix();
    const Vec3 shaken = shaken_mps2 * Vec3(std::sin(9.0 * t), std::cos(7.0 * t), std::sin(8.0 * t));
    out.recording.times_s.push_back(t);
    out.recording.specific_force.col(i) =
        R_world_sensor.transpose() * (kGravity_mps2 * kUp + shaken);
    // The turn about z, seen from the sensor, and the turn about its own x.
    out.recording.angular_velocity.col(i) =
        Eigen::AngleAxisd(-x, Vec3::UnitX()) * Vec3(0.0, 0.0, 1.2 * std::cos(t)) +
        Vec3(1.8 * std::cos(2.0 * t), 0.0, 0.0) + bias;
    out.up.col(i) = R_world_sensor.transpose() * kUp;
  }
  return out;
}

Eigen::Matrix3Xd causal(const SensorRecording& recording) {
  return gravity_directions(recording, GravityAverage::causal);
}

Eigen::Matrix3Xd both_ways(const SensorRecording& recording) {
  return gravity_directions(recording, GravityAverage::whole_take);
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180.0 / 3.14159265358979323846;
}

double worst_degrees(const Eigen::Matrix3Xd& found, const Eigen::Matrix3Xd& wanted, double from_s) {
  double worst = 0.0;
  for (auto t = static_cast<Eigen::Index>(from_s * kRate_hz); t < found.cols(); ++t)
    worst = std::max(worst, degrees_between(found.col(t), wanted.col(t)));
  return worst;
}

TEST(GravityDirection, IsExactWhereNothingAccelerates) {
  const Moved sensor = moved(10.0, 0.0);
  const auto online = causal(sensor.recording);
  EXPECT_LT(worst_degrees(online, sensor.up, GravityDirectionFilter::kUnsure_s + 0.02), 0.1);
  EXPECT_LT(worst_degrees(both_ways(sensor.recording), sensor.up, 0.0), 0.1);
}

TEST(GravityDirection, SeesThroughShaking) {
  // The accelerometer alone is off by up to atan(5 / 9.81) = 27 degrees.
  const Moved sensor = moved(20.0, 5.0);
  EXPECT_LT(worst_degrees(causal(sensor.recording), sensor.up, 3.0), 4.0);
  EXPECT_LT(worst_degrees(both_ways(sensor.recording), sensor.up, 0.0), 4.0);
}

TEST(GravityDirection, LeansByABiasOnlyAsFarAsItTurnsWithinTheAverage) {
  const double bias = 0.01;
  const Moved sensor = moved(60.0, 0.0, Vec3(bias, 0.0, 0.0));
  const double limit = 57.3 * bias * GravityDirectionFilter::kTimeConstant_s;
  EXPECT_LT(worst_degrees(causal(sensor.recording), sensor.up, 0.6), 1.1 * limit);
}

TEST(GravityDirection, IsUnsureAtABeginningAndAfterAGap) {
  Moved sensor = moved(10.0, 1.0);
  for (std::size_t t = 400; t < 1000; ++t) sensor.recording.times_s[t] += 1.0;
  const auto found = causal(sensor.recording);
  for (const Eigen::Index begin : {0, 400})
    for (Eigen::Index t = begin; t < begin + 100; ++t)
      EXPECT_EQ(found.col(t).allFinite(), t >= begin + 50) << t;
  EXPECT_TRUE(both_ways(sensor.recording).allFinite());
}

TEST(GravityDirection, KnowsNothingWithoutAGyroscope) {
  Moved sensor = moved(5.0, 1.0);
  sensor.recording.angular_velocity.setZero();  // as devices without one may send
  EXPECT_TRUE(causal(sensor.recording).array().isNaN().all());
  EXPECT_TRUE(both_ways(sensor.recording).array().isNaN().all());
  sensor.recording.angular_velocity.resize(3, 0);
  EXPECT_TRUE(causal(sensor.recording).array().isNaN().all());
  EXPECT_TRUE(both_ways(sensor.recording).array().isNaN().all());
}

TEST(GravityDirection, PassesOverSamplesThatAreNone) {
  Moved sensor = moved(10.0, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Index t : {300, 301, 302, 500})
    sensor.recording.specific_force.col(t).x() = nan;
  for (const auto& found : {causal(sensor.recording), both_ways(sensor.recording)}) {
    EXPECT_FALSE(found.col(301).allFinite());
    EXPECT_LT(degrees_between(found.col(303), sensor.up.col(303)), 0.2);
    EXPECT_LT(degrees_between(found.col(900), sensor.up.col(900)), 0.2);
  }
}

}  // namespace
}  // namespace sparse_mocap
