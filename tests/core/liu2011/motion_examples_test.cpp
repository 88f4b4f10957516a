// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/motion_examples.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::pose_of;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr int kFrames = 60;

class Examples : public ::testing::Test {
 protected:
  // At the database's own rate, so that nothing is resampled.
  const std::vector<Motion> motions_{swaying_motion(template_skeleton(), 1, kFrames, 25.0),
                                     swaying_motion(template_skeleton(), 2, kFrames, 25.0)};
  const MotionExamples examples_{testing::database_of(motions_), template_skeleton()};

  // A frame of the second clip in the heading frame of another, from the motion itself.
  BodyPose seen_from(int frame, int from) const {
    const BodyPose there = pose_of(motions_[1], from);
    BodyPose seen =
        heading_frame_of(template_skeleton(), there, 0.0).from_parent(pose_of(motions_[1], frame));
    // The database tells heights above the floor, which is where the feet are lowest.
    seen.root_position.y() += examples_.pose(kFrames + from).root_position.y() -
                              pose_of(motions_[1], from).root_position.y();
    return seen;
  }
};

TEST_F(Examples, AreTheMotionSeenFromTheFrameBefore) {
  const Skeleton skeleton = template_skeleton();
  for (int frame = 5; frame < kFrames - 1; ++frame) {
    EXPECT_LT(distance_m(skeleton, examples_.next(kFrames + frame), seen_from(frame, frame - 1)),
              5e-3);
    const auto history = examples_.history(kFrames + frame, 4);
    ASSERT_EQ(history.size(), 4U);
    for (int i = 0; i < 4; ++i) {
      const auto& place = history[static_cast<std::size_t>(i)];
      EXPECT_EQ(place.frame, kFrames + frame - 1 - i);
      const BodyPose placed = place.heading.to_parent(examples_.pose(place.frame));
      EXPECT_LT(distance_m(skeleton, placed, seen_from(frame - 1 - i, frame - 1)), 5e-3);
    }
  }
}

TEST_F(Examples, NeverReachIntoAnotherClip) {
  for (const int frame : {0, 1, kFrames, kFrames + 1, kFrames + 2})
    for (const auto& place : examples_.history(frame, 5))
      EXPECT_EQ(place.frame < kFrames, frame < kFrames);
  for (const auto& place : examples_.history(kFrames, 3)) {
    EXPECT_EQ(place.frame, kFrames);
    EXPECT_EQ(place.heading.origin, Vec3::Zero());
  }
}

// Frames of clips that are not used take no part, but in the mean.
TEST_F(Examples, HaveTheSameVectorsWhereOnlySomeAreUsed) {
  std::vector<bool> is_used(2 * kFrames, false);
  std::fill(is_used.begin() + kFrames, is_used.end(), true);
  const MotionExamples some(testing::database_of(motions_), template_skeleton(), Direction::forward,
                            is_used);
  const auto reference = examples_.reference(examples_.mean());
  for (const int frame : {kFrames, kFrames + 30})
    EXPECT_EQ(some.vectors(some.history(frame, 3), some.reference(some.mean())),
              examples_.vectors(examples_.history(frame, 3), reference));
}

TEST_F(Examples, HaveTheVectorsOfTheirPoses) {
  const Skeleton skeleton = template_skeleton();
  testing::Random random(3);
  const BodyPose about = testing::random_pose(skeleton, random, 0.4);
  const auto reference = examples_.reference(about);
  for (int frame = 0; frame < 2 * kFrames; frame += 7) {
    const MotionExamples::Place place{frame, {random.in(-2.0, 2.0), {0.3, 0.0, -0.2}}};
    Eigen::VectorXd vector(num_freedoms(skeleton));
    examples_.put_vector(place, reference, vector.data());
    const BodyPose pose = place.heading.to_parent(examples_.pose(frame));
    EXPECT_LT((vector - pose_vector(skeleton, about, pose)).norm(), 1e-5);
  }
}

TEST_F(Examples, HaveAMeanInTheirMidst) {
  const Skeleton skeleton = template_skeleton();
  const std::vector<int> frames{kFrames + 10, kFrames + 11, kFrames + 12};
  const Eigen::Vector3d weights(1.0, 2.0, 1.0);
  const BodyPose mean = examples_.mean_next(frames, weights);
  const auto reference = examples_.reference(mean);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(num_freedoms(skeleton));
  for (std::size_t k = 0; k < 3; ++k)
    sum += weights[static_cast<Eigen::Index>(k)] *
           examples_.vectors(
               std::vector{MotionExamples::Place{frames[k], examples_.step(frames[k])}}, reference);
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / 4.0, 1e-3);
  EXPECT_LT(distance_m(skeleton, examples_.mean_next(std::vector{70}, Eigen::VectorXd::Ones(1)),
                       examples_.next(70)),
            1e-5);
}

TEST_F(Examples, MoveAsFarAsTheBodysLegsAreLong) {
  StandardBones bones = template_bones();
  for (Vec3& bone : bones) bone *= 1.2;
  const MotionExamples large(testing::database_of(motions_), make_standard_skeleton(bones));
  EXPECT_LT((large.step(30).origin - 1.2 * examples_.step(30).origin).norm(), 1e-9);
  EXPECT_NEAR(large.pose(30).root_position.y(), 1.2 * examples_.pose(30).root_position.y(), 1e-9);
  EXPECT_EQ(large.step(30).yaw_rad, examples_.step(30).yaw_rad);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
