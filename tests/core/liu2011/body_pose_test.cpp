// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/body_pose.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::Random;
using testing::random_pose;
using testing::template_skeleton;

Mat3 exponential(const Vec3& v) {
  return Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
}

TEST(PoseVector, IsUndoneByMoved) {
  const Skeleton skeleton = template_skeleton();
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const BodyPose reference = random_pose(skeleton, random, 1.0);
    const BodyPose pose = random_pose(skeleton, random, 1.0);
    const Eigen::VectorXd vector = pose_vector(skeleton, reference, pose);
    ASSERT_EQ(vector.size(), 46);
    EXPECT_LT(distance_m(skeleton, moved(skeleton, reference, vector), pose), 1e-9);
  }
}

TEST(PoseVector, OfTheReferenceIsZero) {
  const Skeleton skeleton = template_skeleton();
  Random random(2);
  const BodyPose pose = random_pose(skeleton, random, 1.0);
  EXPECT_LT(pose_vector(skeleton, pose, pose).norm(), 1e-9);
}

TEST(PoseVectorJacobian, AgreesWithDifferences) {
  const Skeleton skeleton = template_skeleton();
  Random random(3);
  const BodyPose reference = random_pose(skeleton, random, 0.7);
  const BodyPose pose = random_pose(skeleton, random, 0.7);
  const Eigen::VectorXd vector = pose_vector(skeleton, reference, pose);
  const Eigen::MatrixXd jacobian = pose_vector_jacobian(skeleton, vector);
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(vector.size(), i);
    const Eigen::VectorXd difference =
        (pose_vector(skeleton, reference, moved(skeleton, pose, step)) -
         pose_vector(skeleton, reference, moved(skeleton, pose, -step))) /
        (2.0 * kStep);
    EXPECT_LT((difference - jacobian.col(i)).norm(), 1e-6) << i;
  }
}

TEST(Logarithm, IsTheRotationVector) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 v = random.vector(1.7);
    EXPECT_LT((logarithm(exponential(v)) - v).norm(), 1e-9);
  }
  EXPECT_LT(logarithm(Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(logarithm(exponential({0.0, kPi, 0.0})).norm(), kPi, 1e-9);
}

TEST(JacobianInverses, AgreeWithDifferences) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 v = random.vector(trial < 25 ? 1.5 : 1e-5);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Vec3 step = 1e-6 * Vec3::Unit(i);
      const Vec3 left = (logarithm(exponential(step) * exponential(v)) -
                         logarithm(exponential(-step) * exponential(v))) /
                        2e-6;
      const Vec3 right = (logarithm(exponential(v) * exponential(step)) -
                          logarithm(exponential(v) * exponential(-step))) /
                         2e-6;
      EXPECT_LT((left - left_jacobian_inverse(v).col(i)).norm(), 1e-5);
      EXPECT_LT((right - right_jacobian_inverse(v).col(i)).norm(), 1e-5);
    }
  }
}

TEST(HeadingFrame, StandsUnderThePoseAndFacesItsWay) {
  const Skeleton skeleton = template_skeleton();
  Random random(6);
  const BodyPose pose = random_pose(skeleton, random, 0.4);
  const HeadingFrame frame = heading_frame_of(skeleton, pose, 0.0);
  const BodyPose own = frame.from_parent(pose);
  EXPECT_NEAR(own.root_position.x(), 0.0, 1e-12);
  EXPECT_NEAR(own.root_position.z(), 0.0, 1e-12);
  EXPECT_EQ(own.root_position.y(), pose.root_position.y());
  EXPECT_NEAR(heading_frame_of(skeleton, own, 0.0).yaw_rad, 0.0, 1e-9);
  EXPECT_LT(distance_m(skeleton, frame.to_parent(own), pose), 1e-12);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
