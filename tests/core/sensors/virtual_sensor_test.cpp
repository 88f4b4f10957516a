// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/virtual_sensor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "sparse_mocap/base/errors.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::resting_motion;
using testing::swaying_motion;
using testing::template_skeleton;

VirtualReadings readings_at(const Motion& motion, std::string_view site) {
  const Site& at = all_sites()[static_cast<std::size_t>(find_site(site))];
  return virtual_readings(motion, std::span(&at, 1)).front();
}

// Across the left shin, in its sensor's mounting: x down the bone, z forward, so y to the right.
const double kShin_m = std::hypot(0.144, 0.396);
const Vec3 kAcrossShin = Vec3(0.396, 0.144, 0.0) / kShin_m;
const Vec3 kUpAtShin = Vec3(-0.396, 0.144, 0.0) / kShin_m;  // at rest, sensor axes

// The left shin turns about the y axis of its sensor by angle_rad(time); the knee stays.
Motion swinging_shin(const std::function<double(double)>& angle_rad, double rate_hz, int frames) {
  Motion motion = resting_motion(template_skeleton(), frames, rate_hz);
  for (int t = 0; t < frames; ++t)
    motion.rotation(t, ltibia) = Quat(Eigen::AngleAxisd(angle_rad(t / rate_hz), kAcrossShin));
  return motion;
}

TEST(Sites, AreMountedAsThePaperSays) {
  for (const auto& site : all_sites()) {
    EXPECT_LT((site.R_joint_sensor.transpose() * site.R_joint_sensor - Mat3::Identity()).norm(),
              1e-12);
    EXPECT_NEAR(site.R_joint_sensor.determinant(), 1.0, 1e-12) << site.name;
  }
  const auto mounting = [](std::string_view name) {
    return all_sites()[static_cast<std::size_t>(find_site(name))].R_joint_sensor;
  };
  EXPECT_LT((mounting("left_wrist").col(0) - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((mounting("right_wrist").col(0) + Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((mounting("left_wrist").col(2) - kUp).norm(), 1e-12);
  EXPECT_LT((mounting("right_wrist").col(2) - kUp).norm(), 1e-12);
  for (const auto* leg : {"left_ankle", "right_ankle", "left_thigh", "right_thigh"}) {
    EXPECT_LT(mounting(leg).col(0).y(), -0.9) << leg;
    EXPECT_LT((mounting(leg).col(2) - Vec3::UnitZ()).norm(), 1e-12) << leg;
  }
  EXPECT_EQ(paper_sites(), (std::vector<int>{find_site("left_wrist"), find_site("right_wrist"),
                                             find_site("left_ankle"), find_site("right_ankle")}));
}

TEST(Sites, AreListedWhenOneIsUnknown) {
  try {
    find_site("left_ear");
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("left_ear"), std::string::npos);
    for (const auto& site : all_sites()) EXPECT_NE(text.find(site.name), std::string::npos);
  }
}

TEST(VirtualReadings, RefuseAnotherSkeleton) {
  Motion motion;
  std::vector<Joint> joints(1);
  joints[0].name = "root";
  motion.skeleton = Skeleton(joints);
  EXPECT_REFUSED(std::invalid_argument, "not on a standard skeleton",
                 virtual_readings(motion, all_sites()));
}

TEST(VirtualReadings, AtRestAreGravityOnTheAxesOfTheMounting) {
  Motion motion = resting_motion(template_skeleton(), 30, 120.0);
  for (int t = 0; t < 30; ++t) {  // legs stand straight; rest pose holds them 20 degrees apart
    motion.rotation(t, lfemur) = Quat::FromTwoVectors(template_bones()[ltibia], -kUp);
    motion.rotation(t, rfemur) = Quat::FromTwoVectors(template_bones()[rtibia], -kUp);
  }
  const auto expect = [&](std::string_view site, const Vec3& wanted) {
    const VirtualReadings readings = readings_at(motion, site);
    for (int t = 0; t < 30; ++t) {
      for (const double place : {0.0, 0.3, 1.0})
        EXPECT_LT((readings.specific_force(place).col(t) - wanted).norm(), 1e-6) << site;
      EXPECT_LT((readings.gravity_direction.col(t) * 9.81 - wanted).norm(), 1e-9);
      EXPECT_LT(readings.angular_velocity.col(t).norm(), 1e-12);
    }
  };
  expect("left_wrist", {0, 0, 9.81});
  expect("right_wrist", {0, 0, 9.81});
  expect("left_ankle", {-9.81, 0, 0});
  expect("right_ankle", {-9.81, 0, 0});
  expect("head", {9.81, 0, 0});
  expect("pelvis", {9.81, 0, 0});
}

// A pendulum theta(t) = A sin(w t) about the fixed knee: in the sensor's axes the centripetal part
// is -L theta'^2 along x, the tangential one -L theta'' along z, and up turns back by theta.
TEST(VirtualReadings, OfAPendulumAreItsClosedForm) {
  const double amplitude = 0.6, w = 2.0 * kPi * 1.2, rate_hz = 120.0;
  const Motion motion =
      swinging_shin([&](double s) { return amplitude * std::sin(w * s); }, rate_hz, 360);
  const VirtualReadings readings = readings_at(motion, "left_ankle");
  double squares = 0.0, errors = 0.0;
  for (int t = 2; t < 358; ++t) {
    const double phase = w * t / rate_hz;
    const double theta = amplitude * std::sin(phase);
    const double speed = amplitude * w * std::cos(phase);
    const double bend = -amplitude * w * w * std::sin(phase);
    const double c = std::cos(theta), s = std::sin(theta);
    const Vec3 up(c * kUpAtShin.x() - s * kUpAtShin.z(), kUpAtShin.y(),
                  s * kUpAtShin.x() + c * kUpAtShin.z());
    const Vec3 own(-kShin_m * speed * speed, 0.0, -kShin_m * bend);
    const Vec3 found = readings.specific_force_end.col(t) - 9.81 * up;
    errors += (found - own).squaredNorm();
    squares += own.squaredNorm();
    EXPECT_LT((readings.gravity_direction.col(t) - up).norm(), 1e-9);
    EXPECT_NEAR(readings.angular_velocity(1, t), speed, 0.02 * amplitude * w);
    EXPECT_LT((readings.specific_force_pivot.col(t) - 9.81 * up).norm(), 1e-6);
  }
  EXPECT_LT(std::sqrt(errors / squares), 0.02);
}

TEST(VirtualReadings, OnAWheelPullInwardsByRadiusTimesSpeedSquared) {
  const double w = 6.0, rate_hz = 120.0;
  const Motion motion = swinging_shin([&](double s) { return w * s; }, rate_hz, 240);
  const VirtualReadings readings = readings_at(motion, "left_ankle");
  for (const double place : {0.25, 0.5, 1.0}) {
    const Eigen::Matrix3Xd own = readings.specific_force(place) - 9.81 * readings.gravity_direction;
    for (int t = 3; t < 237; ++t) {
      EXPECT_NEAR(own(0, t), -place * kShin_m * w * w, 0.02 * place * kShin_m * w * w);
      EXPECT_LT(own.col(t).tail<2>().norm(), 0.02 * place * kShin_m * w * w);
      EXPECT_LT((readings.angular_velocity.col(t) - Vec3(0, w, 0)).norm(), 0.02 * w);
    }
  }
}

TEST(VirtualReadings, OfAFallAreNothing) {
  Motion motion = resting_motion(template_skeleton(), 60, 120.0);
  for (int t = 0; t < 60; ++t)
    motion.root_positions[static_cast<std::size_t>(t)].y() = 5.0 - 0.5 * 9.81 * t * t / 14400.0;
  for (const auto& site : all_sites()) {
    const auto readings = readings_at(motion, site.name);
    EXPECT_LT(readings.specific_force_end.middleCols(3, 54).colwise().norm().maxCoeff(), 1e-6);
  }
}

TEST(VirtualReadings, PutRotationsIntoTheWorld) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 20, 120.0);
  for (const auto& site : all_sites()) {
    const auto readings = readings_at(motion, site.name);
    for (int t = 0; t < 20; ++t) {
      const auto at = motion.transforms(t);
      const Mat3 expected = at.R_world_joint[site.orientation] * site.R_joint_sensor;
      EXPECT_LT((readings.R_world_sensor[static_cast<std::size_t>(t)] - expected).norm(), 1e-12);
    }
  }
}

// Which site is on the other side: names differ by left and right.
std::string other_side(std::string name) {
  if (name.starts_with("left_")) return "right_" + name.substr(5);
  if (name.starts_with("right_")) return "left_" + name.substr(6);
  return name;
}

TEST(VirtualReadings, OfAMirroredMotionChangeSidesAndNegateY) {
  const Motion motion =
      swaying_motion(make_standard_skeleton(averaged_bones({template_bones()})), 2, 60, 120.0);
  const Motion mirror = mirrored(motion, standard_left_right());
  const Vec3 polar(1, -1, 1), axial(-1, 1, -1);
  for (const auto& site : all_sites()) {
    const auto here = readings_at(motion, site.name);
    const auto there = readings_at(mirror, other_side(std::string(site.name)));
    const auto expect = [&](const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b,
                            const Vec3& sign) {
      EXPECT_LT((Eigen::MatrixXd(sign.asDiagonal() * a) - b).cwiseAbs().maxCoeff(), 1e-6)
          << site.name;
    };
    expect(here.specific_force_pivot, there.specific_force_pivot, polar);
    expect(here.specific_force_end, there.specific_force_end, polar);
    expect(here.gravity_direction, there.gravity_direction, polar);
    expect(here.angular_velocity, there.angular_velocity, axial);
  }
}

TEST(VirtualReadings, OfAReversedMotionAreTheSameBackwards) {
  const Motion motion = swaying_motion(template_skeleton(), 3, 80, 120.0);
  for (const auto& site : all_sites()) {
    const auto forwards = readings_at(motion, site.name);
    const auto backwards = readings_at(reversed(motion), site.name);
    for (int t = 4; t < 76; ++t) {
      EXPECT_LT(
          (forwards.specific_force_end.col(t) - backwards.specific_force_end.col(79 - t)).norm(),
          1e-6);
      EXPECT_LT((forwards.angular_velocity.col(t) + backwards.angular_velocity.col(79 - t)).norm(),
                1e-9);
    }
  }
}

TEST(VirtualReadings, OfOneOrTwoFramesAreGravityAlone) {
  for (const int frames : {1, 2}) {
    const Motion motion = swaying_motion(template_skeleton(), 4, frames, 120.0);
    const auto readings = readings_at(motion, "left_wrist");
    EXPECT_LT((readings.specific_force_end - 9.81 * readings.gravity_direction).norm(), 1e-9);
  }
}

TEST(SpecificForceAlong, IsExactOnAParabola) {
  const Vec3 acceleration(1.0, -2.0, 0.5);
  Eigen::Matrix3Xd path(3, 10);
  for (int t = 0; t < 10; ++t) path.col(t) = Vec3(1, 2, 3) * t + acceleration * t * t * 5e-5;
  const Mat3 R = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto force = specific_force_along(path, std::vector<Mat3>(10, R), 0.01);
  for (int t = 0; t < 10; ++t)
    EXPECT_LT((R * force.col(t) - acceleration - Vec3(0, 9.81, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace sparse_mocap
