// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/oriented_limbs.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/joint_rotations.hpp"
#include "sparse_mocap/path_regression/frame_target.hpp"
#include "sparse_mocap/retrieval/shared_heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;
using testing::template_skeleton;
using namespace standard_joint;

constexpr double kLever_m = 0.2;

std::vector<Sensor> worn() {
  std::vector<Sensor> sensors;
  for (const char* site :
       {"left_wrist", "right_wrist", "left_ankle", "right_ankle", "head", "pelvis"})
    sensors.push_back({find_site(site), 1.0, Channel::specific_force | Channel::orientation});
  return sensors;
}

JointTransforms posed(const JointRotations& rotations) {
  JointTransforms pose;
  forward_kinematics(template_skeleton(), Vec3::Zero(), rotations, pose);
  return pose;
}

Reading reading_of(const JointTransforms& pose, double yaw_rad) {
  Reading reading(static_cast<Eigen::Index>(worn().size()));
  reading.specific_force.setZero();
  for (std::size_t s = 0; s < worn().size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(worn()[s].site)];
    const Quat q(yaw_rotation(yaw_rad) * pose.R_world_joint[site.orientation] *
                 site.R_joint_sensor);
    reading.orientation.col(static_cast<Eigen::Index>(s)) << q.w(), q.x(), q.y(), q.z();
  }
  return reading;
}

// Retrieved poses have the right upper body and hips, and other shanks, forearms and hands.
TEST(PlaceOrientedLimbs, TurnsTheLimbsAsMeasuredWhereverThePerformerFaces) {
  const Skeleton skeleton = template_skeleton();
  const auto signals = retrieval::all_signals(with_turning(worn()));
  Random random(1);
  for (const double yaw_rad : {0.0, 2.5}) {
    const JointRotations truth =
        joint_rotations(skeleton, random.column(skeleton.num_angles(), 0.4));
    JointRotations retrieved = truth;
    for (const Index joint : {ltibia, rtibia, lradius, rradius, lwrist, rwrist, head})
      retrieved[joint] = reachable(
          skeleton, joint_rotations(skeleton, random.column(skeleton.num_angles(), 0.4)))[joint];
    Eigen::VectorXd points = pose_points(posed(retrieved), kLever_m);
    const Eigen::VectorXd wanted = pose_points(posed(truth), kLever_m);
    const double before = (points - wanted).norm();
    const auto row = retrieval::signal_row(reading_of(posed(truth), yaw_rad), signals);
    place_oriented_limbs(skeleton, signals, row, kLever_m, points);
    EXPECT_LT((points - wanted).norm(), 0.2 * before);
    const Eigen::Index shank_tips = 3 * skeleton.num_joints() + 9 * ltibia;
    EXPECT_GT(before, 0.05);
    EXPECT_LT((points - wanted).segment<9>(shank_tips).norm(), 0.03);
  }
}

TEST(PlaceOrientedLimbs, LeavesPosesWithoutOrientationsAlone) {
  const Skeleton skeleton = template_skeleton();
  const auto signals = retrieval::all_signals({{find_site("left_wrist")}, {find_site("pelvis")}});
  Eigen::VectorXd points = pose_points(rest_pose(skeleton), kLever_m);
  const Eigen::VectorXd before = points;
  place_oriented_limbs(skeleton, signals, Eigen::RowVectorXf::Zero(6), kLever_m, points);
  EXPECT_EQ(points, before);
}

TEST(WithTurning, LeavesOrientationsOutWhereNothingTellsTheHeading) {
  const auto alone =
      with_turning({{find_site("left_wrist"), 1.0, Channel::specific_force | Channel::orientation},
                    {find_site("right_ankle"), 1.0, Channel::orientation}});
  EXPECT_EQ(alone[0].channels, Channels(Channel::specific_force));
  EXPECT_TRUE(alone[1].channels.is_empty());
  EXPECT_EQ(with_turning(worn())[0].channels, Channel::specific_force | Channel::orientation |
                                                  Channel::gravity_direction |
                                                  Channel::angular_velocity);
}

TEST(TurningOf, SaysWhatAGyroscopeWould) {
  const JointRotations rest(kNumStandardJoints, Mat3::Identity());
  TurningOf turning(worn());
  Reading first = reading_of(posed(rest), 0.0), second = reading_of(posed(rest), 0.1);
  second.time_s = 0.04;
  turning(first);
  const Reading told = turning(second);
  for (Eigen::Index s = 0; s < told.num_sensors(); ++s) {
    const Vec3 up = told.gravity_direction.col(s);
    EXPECT_NEAR(up.norm(), 1.0, 1e-9);
    EXPECT_NEAR(up.dot(told.angular_velocity.col(s)), 0.1 / 0.04, 1e-6);  // about the vertical
    EXPECT_NEAR(told.angular_velocity.col(s).norm(), 0.1 / 0.04, 1e-6);
  }
  Reading measured = second;
  measured.gravity_direction.setConstant(0.5);
  TurningOf own({{find_site("head"), 1.0,
                  Channel::orientation | Channel::gravity_direction | Channel::angular_velocity}});
  EXPECT_EQ(own(measured).gravity_direction.col(0), measured.gravity_direction.col(0));
}

}  // namespace
}  // namespace sparse_mocap::path_regression
