// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/joint_rotations.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

const Skeleton kSkeleton = testing::template_skeleton();

JointTransforms posed(const JointRotations& rotations) {
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), rotations, pose);
  return pose;
}

TEST(JointRotations, AreThoseOfTheAngles) {
  Random random(1);
  const Eigen::VectorXd angles = random.column(kNumStandardAngles, 2.0);
  JointTransforms expected;
  forward_kinematics(kSkeleton, Vec3::Zero(), angles, expected);
  EXPECT_LT(
      (stacked_ends(posed(joint_rotations(kSkeleton, angles))) - stacked_ends(expected)).norm(),
      1e-12);
}

TEST(Reachable, KeepsPosesThatJointsAllowAndBringsOthersBack) {
  Random random(2);
  const auto pose = joint_rotations(kSkeleton, random.column(kNumStandardAngles, 1.2));
  const auto same = reachable(kSkeleton, pose);
  for (std::size_t j = 0; j < pose.size(); ++j) EXPECT_LT((same[j] - pose[j]).norm(), 1e-9) << j;
  JointRotations anything;
  for (int j = 0; j < kSkeleton.num_joints(); ++j)
    anything.push_back(random.rotation().toRotationMatrix());
  const auto once = reachable(kSkeleton, anything);
  const auto twice = reachable(kSkeleton, once);
  for (std::size_t j = 0; j < once.size(); ++j) EXPECT_LT((twice[j] - once[j]).norm(), 1e-6) << j;
  const Joint& knee = kSkeleton.joint(standard_joint::ltibia);
  const Vec3 axis = knee.R_joint_axes * unit(knee.axes[0]);
  EXPECT_LT((once[standard_joint::ltibia] * axis - axis).norm(), 1e-12);
}

TEST(Turned, StaysReachableAndGoesBackByTheOppositeStep) {
  Random random(3);
  const auto pose = joint_rotations(kSkeleton, random.column(kNumStandardAngles, 1.0));
  const Eigen::VectorXd step = random.column(kNumStandardAngles, 0.8);
  const auto there = turned(kSkeleton, pose, step);
  const auto back = turned(kSkeleton, there, -step);
  const auto same = reachable(kSkeleton, there);
  for (std::size_t j = 0; j < pose.size(); ++j) {
    EXPECT_LT((back[j] - pose[j]).norm(), 1e-9) << j;
    EXPECT_LT((same[j] - there[j]).norm(), 1e-9) << j;
  }
}

TEST(StepJacobians, EqualCentralDifferences) {
  Random random(4);
  // Angles far from rest, hips turned through what would be gimbal lock.
  Eigen::VectorXd angles = random.column(kNumStandardAngles, 1.0);
  angles[kSkeleton.angle_begin(standard_joint::lfemur) + 1] = kPi / 2.0;
  const auto pose = joint_rotations(kSkeleton, angles);
  const StepJacobians found = step_jacobians(kSkeleton, pose, posed(pose));
  constexpr double kStep = 1e-6;
  for (Eigen::Index a = 0; a < kNumStandardAngles; ++a) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(kNumStandardAngles, a);
    const JointTransforms more = posed(turned(kSkeleton, pose, step));
    const JointTransforms less = posed(turned(kSkeleton, pose, -step));
    const Eigen::VectorXd slope = (stacked_ends(more) - stacked_ends(less)) / (2.0 * kStep);
    EXPECT_LT((found.ends.col(a) - slope).norm(), 1e-7) << a;
    for (std::size_t j = 0; j < more.R_world_joint.size(); ++j) {
      const Eigen::AngleAxisd turn(Mat3(more.R_world_joint[j] * less.R_world_joint[j].transpose()));
      const Vec3 rate = turn.angle() * turn.axis() / (2.0 * kStep);
      EXPECT_LT((found.turns.block<3, 1>(3 * static_cast<Eigen::Index>(j), a) - rate).norm(), 1e-5);
    }
  }
}

}  // namespace
}  // namespace sparse_mocap
