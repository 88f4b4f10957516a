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
  const auto signals = retrieval::all_signals(worn());
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
    EXPECT_EQ(place_oriented_limbs(skeleton, signals, row, kLever_m, points), 6);
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
  EXPECT_EQ(place_oriented_limbs(skeleton, signals, Eigen::RowVectorXf::Zero(6), kLever_m, points),
            0);
  EXPECT_EQ(points, before);
}

TEST(PosedSensors, AreWhereThePoseHasThem) {
  const Skeleton skeleton = template_skeleton();
  auto sensors = worn();
  sensors[1].channels = Channel::specific_force;
  Random random(2);
  const JointTransforms pose =
      posed(joint_rotations(skeleton, random.column(skeleton.num_angles(), 0.4)));
  std::vector<Mat3> R(sensors.size(), Mat3::Identity());
  put_posed_sensors(skeleton, retrieval::all_signals(sensors), kLever_m,
                    pose_points(pose, kLever_m), R);
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(sensors[s].site)];
    const Mat3 wanted = s == 1 ? Mat3(Mat3::Zero())
                               : Mat3(pose.R_world_joint[site.orientation] * site.R_joint_sensor);
    EXPECT_LT((R[s] - wanted).norm(), 1e-9) << s;
  }
}

}  // namespace
}  // namespace sparse_mocap::path_regression
