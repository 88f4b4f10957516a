// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/standing_feet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/database/clip_motion.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using namespace standard_joint;

// A clip whose left foot stands in the first half, and whose right one always does.
std::shared_ptr<const MotionDatabase> half_standing() {
  DatabaseContent content = testing::content_of(
      {testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0)}, 25.0);
  testing::change_rows(content, 0, [](DatabaseRows& rows) {
    for (int n = 0; n < 20; ++n) rows.contacts.row(n) << (n < 10 ? 1.0F : 0.0F), 1.0F;
  });
  return testing::database_of(content);
}

WeightedPaths paths_to(const std::vector<int>& frames, const Eigen::VectorXd& weights) {
  WeightedPaths weighted;
  for (const int frame : frames) weighted.paths.push_back({frame, 1.0, 1, -1});
  weighted.weights = weights;
  return weighted;
}

TEST(StandingFeet, AreAVoteOfTheRetrievedFrames) {
  const auto database = half_standing();
  const StandingHeights heights(*database);
  const auto feet =
      standing_feet(*database, paths_to({2, 4, 15}, Eigen::Vector3d(0.5, 0.2, 0.3)), heights);
  EXPECT_NEAR(feet.certainty[0], 0.7, 1e-9);
  EXPECT_NEAR(feet.certainty[1], 1.0, 1e-9);
  const auto none = standing_feet(*database, paths_to({15}, Eigen::VectorXd::Ones(1)), heights);
  EXPECT_EQ(none.certainty[0], 0.0);
  EXPECT_EQ(none.height_m[0], heights.usual_m()[0]);
  EXPECT_EQ(none.step_m[0], Vec3::Zero());
}

// Steps and heights against the clip as a motion in the world, where ankles are simply looked at.
TEST(StandingFeet, MoveAsTheAnklesOfTheClipDo) {
  const auto database = half_standing();
  const Motion motion = clip_motion(*database, 0);
  const auto yaws = headings(motion);
  for (const int frame : {1, 5, 9}) {
    const auto feet = standing_feet(*database, paths_to({frame}, Eigen::VectorXd::Ones(1)),
                                    StandingHeights(*database));
    const JointTransforms now = motion.transforms(frame), before = motion.transforms(frame - 1);
    for (const auto& [side, ankle] :
         {std::pair<Eigen::Index, std::size_t>{0, ltibia}, {1, rtibia}}) {
      const Vec3 step = yaw_rotation(yaws[static_cast<std::size_t>(frame - 1)]).transpose() *
                        (now.end[ankle] - before.end[ankle]);
      EXPECT_LT((feet.step_m[static_cast<std::size_t>(side)] - step).norm(), 1e-4) << frame;
      EXPECT_NEAR(feet.height_m[side], now.end[ankle].y(), 1e-4);
    }
  }
}

TEST(StandingHeights, AreMeansOverTheFramesThatStand) {
  const auto database = half_standing();
  const Motion motion = clip_motion(*database, 0);
  double left = 0.0, right = 0.0;
  for (int t = 0; t < 20; ++t) {
    const JointTransforms pose = motion.transforms(t);
    if (t < 10) left += pose.end[ltibia].y() / 10.0;
    right += pose.end[rtibia].y() / 20.0;
  }
  const StandingHeights heights(*database);
  EXPECT_EQ(heights.excess_m(0), 0.0);
  EXPECT_NEAR(heights.usual_m()[0], left, 1e-4);
  EXPECT_NEAR(heights.usual_m()[1], right, 1e-4);
}

// A clip, the same recorded on a floor 4 cm lower, and one in which nobody stands.
std::shared_ptr<const MotionDatabase> on_two_floors() {
  const Motion motion = testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0);
  DatabaseContent content = testing::content_of({motion, motion, motion}, 25.0);
  for (auto& rows : content.clip_rows) rows.contacts.setOnes();
  content.clip_rows[1].root_motion.col(root_motion_column::height).array() += 0.04F;
  content.clip_rows[2].contacts.setZero();
  return testing::database_of(content);
}

TEST(StandingHeights, PutAllClipsOnOneFloor) {
  const auto database = on_two_floors();
  const StandingHeights heights(*database);
  EXPECT_NEAR(heights.excess_m(0), -0.02, 1e-6);
  EXPECT_NEAR(heights.excess_m(1), 0.02, 1e-6);
  EXPECT_EQ(heights.excess_m(2), 0.0);
  const auto seen = [&](int frame) {
    const auto path = paths_to({frame}, Eigen::VectorXd::Ones(1));
    return Eigen::Vector3d(root_height_m(*database, path, heights),
                           standing_feet(*database, path, heights).height_m[0],
                           standing_feet(*database, path, heights).height_m[1]);
  };
  const Motion motion = clip_motion(*database, 0);
  for (const int frame : {0, 7, 19}) {
    const JointTransforms pose = motion.transforms(frame);
    const Eigen::Vector3d recorded(pose.end[root].y(), pose.end[ltibia].y(), pose.end[rtibia].y());
    EXPECT_LT((seen(frame) - recorded - Eigen::Vector3d::Constant(0.02)).norm(), 1e-4) << frame;
    EXPECT_LT((seen(20 + frame) - seen(frame)).norm(), 1e-5) << frame;
  }
}

// Lying ankles are lower than standing ones, and say nothing of the floor.
TEST(StandingHeights, LookAtUprightBodies) {
  const Motion standing = testing::resting_motion(testing::template_skeleton(), 20, 25.0, 0.95);
  DatabaseContent content = testing::content_of({standing, standing}, 25.0);
  for (auto& rows : content.clip_rows) rows.contacts.setOnes();
  testing::change_rows(content, 1, [](DatabaseRows& lying) {
    for (const auto ankle : {ltibia, rtibia})  // as high as the root
      lying.positions.block(10, 3 * static_cast<Eigen::Index>(ankle) + 1, 10, 1).setZero();
    lying.root_motion.block(10, root_motion_column::height, 10, 1).setConstant(0.05F);
  });
  EXPECT_NEAR(StandingHeights(*testing::database_of(content)).excess_m(1), 0.0, 1e-4);
}

TEST(StandingCertainty, RisesWithTheVoteAndFallsAsTheShankMoves) {
  for (const double vote : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    EXPECT_EQ(standing_certainty(vote, std::nan("")), vote);
    EXPECT_GT(standing_certainty(vote, 0.1), standing_certainty(vote, 2.0));
    EXPECT_GT(standing_certainty(vote, 2.0), standing_certainty(vote, 10.0));
  }
  EXPECT_GT(standing_certainty(1.0, 0.2), 0.9);
  EXPECT_LT(standing_certainty(1.0, 10.0), 0.2);
  EXPECT_LT(standing_certainty(0.0, 2.0), 0.2);
  EXPECT_LT(standing_certainty(0.3, 1.0), standing_certainty(0.6, 1.0));
}

}  // namespace
}  // namespace sparse_mocap::retrieval
