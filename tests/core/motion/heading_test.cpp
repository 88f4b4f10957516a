// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/heading.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/motion/contacts.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::resting_motion;
using testing::swaying_motion;
using testing::template_skeleton;

// A resting body turned by one world rotation.
JointTransforms turned(const Mat3& R) {
  Motion motion = resting_motion(template_skeleton(), 1, 25.0);
  motion.rotation(0, root) = Quat(R);
  return motion.transforms(0);
}

TEST(YawRotation, TurnsForwardTowardsTheLeft) {
  EXPECT_LT((yaw_rotation(kPi / 2) * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((yaw_rotation(0.3) * kUp - kUp).norm(), 1e-12);
}

TEST(Heading, IsTheTurnAboutTheUpAxis) {
  for (double yaw = -3.0; yaw <= 3.0; yaw += 0.25)
    EXPECT_NEAR(heading_of(turned(yaw_rotation(yaw)), 0.0), yaw, 1e-9);
}

TEST(Heading, StaysNearTheLastOne) {
  EXPECT_NEAR(heading_of(turned(yaw_rotation(0.5)), 12.0), 0.5 + 4.0 * kPi, 1e-9);
  EXPECT_NEAR(heading_of(turned(yaw_rotation(-3.0)), 3.0), 2.0 * kPi - 3.0, 1e-9);
}

TEST(Heading, DoesNotMindLeaningForwardOrLyingOnTheBack) {
  for (const double pitch : {-kPi / 2, -0.5, 0.8, kPi / 2})
    EXPECT_NEAR(heading_of(turned(yaw_rotation(0.7) *
                                  Eigen::AngleAxisd(pitch, Vec3::UnitX()).toRotationMatrix()),
                           0.0),
                0.7, 1e-9);
}

TEST(Heading, IsKeptWhileTheHipsStandUpright) {
  const Mat3 on_the_side = Eigen::AngleAxisd(kPi / 2 - 0.1, Vec3::UnitZ()).toRotationMatrix();
  EXPECT_EQ(heading_of(turned(on_the_side), 1.25), 1.25);
}

TEST(Headings, RunOnPastAFullTurn) {
  Motion motion = resting_motion(template_skeleton(), 100, 25.0);
  for (int t = 0; t < 100; ++t) motion.rotation(t, root) = Quat(yaw_rotation(0.2 * t));
  const auto yaw = headings(motion);
  for (int t = 0; t < 100; ++t) EXPECT_NEAR(yaw[static_cast<std::size_t>(t)], 0.2 * t, 1e-9);
}

TEST(JointPositions, AreTheWorldsOnesSeenFromTheFrame) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 30, 25.0);
  const auto world = joint_positions(motion, PositionFrame::world);
  const auto heading = joint_positions(motion, PositionFrame::heading);
  const auto in_root = joint_positions(motion, PositionFrame::root);
  const auto yaw = headings(motion);
  for (int t = 0; t < motion.num_frames(); ++t) {
    const auto at = motion.transforms(t);
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j) {
      const Vec3 end = at.end[static_cast<std::size_t>(j)];
      EXPECT_LT((world.block<3, 1>(3 * j, t) - end).norm(), 1e-12);
      const Vec3 back =
          yaw_rotation(yaw[static_cast<std::size_t>(t)]) * Vec3(heading.block<3, 1>(3 * j, t)) +
          at.end[0];
      EXPECT_LT((back - end).norm(), 1e-12);
      EXPECT_LT(
          (at.R_world_joint[0] * Vec3(in_root.block<3, 1>(3 * j, t)) + at.end[0] - end).norm(),
          1e-12);
    }
  }
}

TEST(JointPositions, IgnoreWhereABodyStandsAndLooks) {
  Motion motion = swaying_motion(template_skeleton(), 2, 30, 25.0);
  const auto before = joint_positions(motion, PositionFrame::heading);
  for (int t = 0; t < motion.num_frames(); ++t) {
    motion.root_positions[static_cast<std::size_t>(t)] += Vec3(3, 0, -2);
    motion.rotation(t, root) = Quat(yaw_rotation(1.1)) * motion.rotation(t, root);
  }
  EXPECT_LT((joint_positions(motion, PositionFrame::heading) - before).cwiseAbs().maxCoeff(), 1e-9);
}

// The root at some height and place along x in each frame, at 25 Hz.
Motion carried(const std::vector<Vec3>& path) {
  Motion motion = resting_motion(template_skeleton(), static_cast<int>(path.size()), 25.0);
  motion.root_positions = path;
  return motion;
}

TEST(FootContacts, OfAStandingBodyAreBoth) {
  EXPECT_EQ(foot_contacts(carried(std::vector<Vec3>(5, Vec3(0, 0.9, 0)))),
            Eigen::Matrix2Xd::Ones(2, 5));
  EXPECT_EQ(foot_contacts(carried({Vec3(0, 0.9, 0)})), Eigen::Matrix2Xd::Ones(2, 1));
}

TEST(FootContacts, EndAtHalfAMetreASecond) {
  std::vector<Vec3> slow, fast;
  for (int t = 0; t < 6; ++t) {
    slow.push_back({0.45 * t / 25.0, 0.9, 0});
    fast.push_back({0.55 * t / 25.0, 0.9, 0});
  }
  EXPECT_EQ(foot_contacts(carried(slow)), Eigen::Matrix2Xd::Ones(2, 6));
  EXPECT_EQ(foot_contacts(carried(fast)), Eigen::Matrix2Xd::Zero(2, 6));
}

TEST(FootContacts, EndSixCentimetresAboveTheFloor) {
  std::vector<Vec3> path;
  for (int t = 0; t < 21; ++t) path.push_back({0, 0.9 + 0.0043 * t, 0});
  const auto contacts = foot_contacts(carried(path));
  for (int t = 0; t < 21; ++t) EXPECT_EQ(contacts(0, t), 0.0043 * t < 0.06 ? 1.0 : 0.0) << t;
  EXPECT_EQ(contacts.row(0), contacts.row(1));
}

TEST(FootContacts, AreOfEachFootByItself) {
  Motion motion = carried(std::vector<Vec3>(10, Vec3(0, 0.9, 0)));
  for (int t = 5; t < 10; ++t)  // the right leg is kept lifted
    motion.rotation(t, rfemur) = Quat(Eigen::AngleAxisd(-1.0, Vec3::UnitX()));
  const auto contacts = foot_contacts(motion);
  EXPECT_EQ(contacts.row(0), Eigen::RowVectorXd::Ones(10));
  EXPECT_EQ(contacts.row(1).head(4), Eigen::RowVectorXd::Ones(4));
  EXPECT_EQ(contacts.row(1).tail(5), Eigen::RowVectorXd::Zero(5));
}

}  // namespace
}  // namespace sparse_mocap
