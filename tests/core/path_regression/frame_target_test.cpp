// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/frame_target.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using namespace standard_joint;
using testing::Random;

const Skeleton kSkeleton = testing::template_skeleton();

JointTransforms posed(const Eigen::VectorXd& angles) {
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), angles, pose);
  return pose;
}

// What a sensor reads of gravity in a pose of the standard skeleton.
Vec3 gravity_direction_at(const Eigen::VectorXd& angles, int site) {
  const Site& worn = all_sites()[static_cast<std::size_t>(site)];
  const Mat3 R_world_sensor =
      posed(angles).R_world_joint[static_cast<std::size_t>(worn.orientation)] * worn.R_joint_sensor;
  return R_world_sensor.transpose() * kUp;
}

TEST(PosePoints, AreEndsAndTheTipsOfTheAxes) {
  Random random(1);
  const JointTransforms pose = posed(random.column(kNumStandardAngles, 0.8));
  const Eigen::VectorXd points = pose_points(pose, 0.2);
  ASSERT_EQ(points.size(), 12 * kNumStandardJoints);
  EXPECT_EQ(Vec3(points.segment<3>(3 * rwrist)), pose.end[rwrist]);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    EXPECT_EQ(Vec3(points.segment<3>(3 * kNumStandardJoints + 9 * head + 3 * axis)),
              Vec3(0.2 * pose.R_world_joint[head].col(axis)));
}

TEST(InclinationTarget, IsMetInThePoseThatWasMeasured) {
  Random random(4);
  const Channels inertial = Channel::specific_force | Channel::gravity_direction;
  const std::vector<Sensor> sensors{{find_site("left_wrist"), 1.0, inertial},
                                    {find_site("right_ankle"), 1.0, inertial},
                                    {find_site("left_thigh"), 1.0, Channel::specific_force},
                                    {find_site("head"), 1.0, inertial}};
  const auto signals = retrieval::compared_signals(sensors, true);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd angles = random.column(kNumStandardAngles, 0.6);
    Reading reading(4);
    for (Eigen::Index s = 0; s < 4; ++s)
      reading.gravity_direction.col(s) =
          gravity_direction_at(angles, sensors[static_cast<std::size_t>(s)].site);
    const auto target = inclination_target(kSkeleton, reading, signals);
    ASSERT_EQ(target.joints, (std::vector<int>{lradius, rtibia}));
    const JointTransforms pose = posed(angles);
    EXPECT_NEAR(target.rises_m[0], pose.end[lradius].y() - pose.end[lhumerus].y(), 1e-12);
    EXPECT_NEAR(target.rises_m[1], pose.end[rtibia].y() - pose.end[rfemur].y(), 1e-12);
  }
}

TEST(TurningTargets, AreTheTurnsAboutTheVertical) {
  Random random(6);
  const Channels inertial =
      Channel::specific_force | Channel::gravity_direction | Channel::angular_velocity;
  const std::vector<Sensor> sensors{{find_site("left_wrist"), 1.0, inertial},
                                    {find_site("right_ankle"), 1.0, inertial}};
  const auto signals = retrieval::compared_signals(sensors, true);
  const Eigen::VectorXd angles = random.column(kNumStandardAngles, 0.6);
  Reading reading(2);
  for (Eigen::Index s = 0; s < 2; ++s) {
    const Vec3 up = gravity_direction_at(angles, sensors[static_cast<std::size_t>(s)].site);
    const Vec3 level = up.cross(random.vector(1.0));
    reading.gravity_direction.col(s) = up;
    reading.angular_velocity.col(s) = (1.5 + static_cast<double>(s)) * up + level;
  }
  const auto targets = turning_targets(reading, signals);
  ASSERT_EQ(targets.size(), 2U);
  EXPECT_EQ(targets[0].joint, lwrist);
  EXPECT_NEAR(targets[0].rate_radps, 1.5, 1e-9);
  EXPECT_EQ(targets[1].joint, rtibia);
  EXPECT_NEAR(targets[1].rate_radps, 2.5, 1e-9);
  reading.angular_velocity.col(0).setConstant(std::nan(""));
  EXPECT_EQ(turning_targets(reading, signals).size(), 1U);
}

TEST(InclinationTarget, LeavesSilentSensorsOut) {
  const auto signals = retrieval::compared_signals(
      {{find_site("left_wrist"), 1.0, Channel::specific_force | Channel::gravity_direction}}, true);
  EXPECT_TRUE(inclination_target(kSkeleton, Reading(1), signals).joints.empty());
}

TEST(BlendedTarget, LeadsFromOneToTheOther) {
  Random random(7);
  FrameTarget a, b;
  a.points = random.column(12 * kNumStandardJoints, 1.0);
  b.points = a.points;
  b.points.head(3 * kNumStandardJoints).array() += 0.1;
  a.step = 0.1 * a.points;
  b.step = 0.3 * b.points;
  b.root.height_m = 1.0;
  b.root.velocity_mps = {0.4, 0.2};
  b.feet.certainty = {1.0, 0.5};
  b.feet.step_m[1] = {0.0, 0.0, 0.02};
  a.agreement = b.agreement = 0.5;
  for (const double share : {0.0, 0.25, 1.0}) {
    const FrameTarget between = blended(a, b, share, 0.2);
    EXPECT_LT((between.points - a.points).norm(), share * (b.points - a.points).norm() + 1e-9);
    EXPECT_LT(((1.0 - share) * a.points + share * b.points - between.points).norm(), 1e-12);
    EXPECT_LT(((1.0 - share) * a.step + share * b.step - between.step).norm(), 1e-12);
    EXPECT_NEAR(between.root.height_m, share, 1e-12);
    EXPECT_NEAR(between.root.velocity_mps.x(), 0.4 * share, 1e-12);
    EXPECT_NEAR(between.feet.certainty[1], 0.5 * share, 1e-12);
    EXPECT_NEAR(between.feet.step_m[1].z(), 0.02 * share, 1e-12);
    // Halves that are 0.1 m apart along each axis spread by share (1 - share) 0.03 m^2.
    const double doubt = 1.0 + share * (1.0 - share) * 0.03 / 0.04;
    EXPECT_NEAR(between.agreement, 1.0 / (1.0 + doubt), 1e-9);
  }
}

TEST(Agreement, OfOneFrameAloneCountsLittle) {
  std::vector<FrameTarget> targets(9);
  for (auto& target : targets) target.agreement = 0.2;
  targets[4].agreement = 1.0;
  even_agreements(targets, 2);
  EXPECT_NEAR(targets[0].agreement, 0.2, 1e-12);
  // Its doubt is 0, that of the four others is 4: the mean is 3.2.
  EXPECT_NEAR(targets[4].agreement, 1.0 / 4.2, 1e-12);
  EXPECT_NEAR(targets[6].agreement, 1.0 / 4.2, 1e-12);
  EXPECT_NEAR(targets[7].agreement, 0.2, 1e-12);
  EXPECT_NEAR(evened_agreement(1.0, 0.2), 1.0 / (1.0 + 0.6 * 4.0), 1e-12);
  EXPECT_NEAR(evened_agreement(0.5, 0.5), 0.5, 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
