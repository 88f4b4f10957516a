// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/heading_drift.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::Random;
using testing::random_pose;
using testing::template_skeleton;

constexpr double kRate_hz = 25.0, kDrift_rad = 0.5 * kRadiansPerDegree;

std::vector<WornSensor> worn() {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_wrist", "right_wrist", "left_ankle", "pelvis"})
    sensors.push_back({find_site(site), 1.0, Channel::orientation});
  return worn_sensors(template_skeleton(), sensors);
}

// Sensors of a pose whose headings are off by these, without positions.
std::vector<Observation> drifted(const BodyPose& pose, const Eigen::VectorXd& yaw_rad) {
  auto observed = sensors_of(template_skeleton(), worn(), pose);
  for (auto& one : observed) {
    one.has_position = false;
    one.measured.R_frame_sensor =
        yaw_rotation(yaw_rad[one.worn.sensor]) * one.measured.R_frame_sensor;
  }
  return observed;
}

std::vector<SensorPose> expected(const BodyPose& pose) {
  std::vector<SensorPose> out;
  for (const auto& one : sensors_of(template_skeleton(), worn(), pose)) out.push_back(one.measured);
  return out;
}

TEST(HeadingDrift, FollowsSensorsThatDriftApart) {
  Random random(1);
  HeadingDrift drift(worn().size(), kDrift_rad, kRate_hz);
  const Eigen::Vector4d rates(0.15, -0.2, 0.3, -0.25);  // degrees a second, no common turn
  for (int t = 0; t < 200 * 25; ++t) {
    const Eigen::VectorXd yaw = rates * (t / kRate_hz) * kRadiansPerDegree;
    const BodyPose pose = random_pose(template_skeleton(), random, 0.2);
    drift.update(drift.corrected(drifted(pose, yaw)),
                 expected(random_pose(template_skeleton(), random, 0.1)));
  }
  for (Eigen::Index s = 0; s < rates.size(); ++s)
    EXPECT_NEAR(drift.of(s), rates[s] * 200.0 * kRadiansPerDegree, 18.0 * kRadiansPerDegree);
  EXPECT_GT(drift.of(2), 40.0 * kRadiansPerDegree);
  drift.reset();
  EXPECT_EQ(drift.of(2), 0.0);
}

TEST(HeadingDrift, TakesACommonTurnForTheBodys) {
  Random random(2);
  HeadingDrift drift(worn().size(), kDrift_rad, kRate_hz);
  const BodyPose pose = random_pose(template_skeleton(), random, 0.2);
  for (int t = 0; t < 100; ++t)
    drift.update(drift.corrected(drifted(pose, Eigen::Vector4d::Constant(0.5))), expected(pose));
  for (Eigen::Index s = 0; s < 4; ++s) EXPECT_NEAR(drift.of(s), 0.0, 1e-9);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
