// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/extremity_vote.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

// Two clips with feet, toes and hands, and one without.
std::shared_ptr<const MotionDatabase> database_with_extremities() {
  const Skeleton full = with_extremities(testing::template_skeleton());
  DatabaseContent content = testing::content_of(
      {testing::swaying_motion(full, 1, 20, 25.0), testing::swaying_motion(full, 2, 20, 25.0),
       testing::swaying_motion(full, 3, 20, 25.0)},
      25.0);
  content.skeleton = testing::template_skeleton();
  content.clips[0].has_extremity.fill(true);
  content.clips[1].has_extremity.fill(true);
  return testing::database_of(content);
}

WeightedPaths paths_to(const std::vector<int>& frames, const Eigen::VectorXd& weights) {
  WeightedPaths weighted;
  for (const int frame : frames) weighted.paths.push_back({frame, 1.0, 1, -1});
  weighted.weights = weights;
  return weighted;
}

Quat stored(const MotionDatabase& database, int frame, int e) {
  return rotation_of_vector(
      database.extremities().row(frame).segment<3>(3 * e).transpose().cast<double>());
}

TEST(ExtremityVote, OfOneFrameIsThatFrame) {
  const auto database = database_with_extremities();
  const auto vote = extremity_vote(*database, paths_to({7}, Eigen::VectorXd::Ones(1)));
  const Motion source =
      testing::swaying_motion(with_extremities(testing::template_skeleton()), 1, 20, 25.0);
  for (int e = 0; e < kNumExtremities; ++e) {
    const auto i = static_cast<std::size_t>(e);
    EXPECT_EQ(vote.certainty[i], 1.0);
    EXPECT_LT(vote.R_parent_joint[i].angularDistance(source.rotation(7, extremity_joint(e))), 3e-4);
  }
}

// The oracle is the eigenvector of Markley et al. 2007 (J. Guid. Control Dyn. 30), the chordal
// mean.
TEST(ExtremityVote, IsTheMeanOnTheRotationGroup) {
  const auto database = database_with_extremities();
  const std::vector<int> frames{3, 4, 5, 25};
  const Eigen::Vector4d weights(0.4, 0.3, 0.2, 0.1);
  const auto vote = extremity_vote(*database, paths_to(frames, weights));
  for (int e = 0; e < kNumExtremities; ++e) {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Eigen::Vector4d q = stored(*database, frames[i], e).coeffs();
      sum += weights[static_cast<Eigen::Index>(i)] * q * q.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
    const Quat mean(Eigen::Vector4d(solver.eigenvectors().col(3)));
    EXPECT_LT(vote.R_parent_joint[static_cast<std::size_t>(e)].angularDistance(mean), 0.02);
  }
}

TEST(ExtremityVote, LeavesOutFramesWhoseFilesHaveNone) {
  const auto database = database_with_extremities();
  const auto vote = extremity_vote(*database, paths_to({5, 45}, Eigen::Vector2d(0.25, 0.75)));
  EXPECT_NEAR(vote.certainty[extremity::lfoot], 0.25, 1e-12);
  EXPECT_LT(vote.R_parent_joint[extremity::lfoot].angularDistance(stored(*database, 5, 0)), 1e-6);
  const auto none = extremity_vote(*database, paths_to({45}, Eigen::VectorXd::Ones(1)));
  EXPECT_EQ(none.certainty[extremity::rhand], 0.0);
  const auto plain = testing::database_of(
      {testing::swaying_motion(testing::template_skeleton(), 1, 20, 25.0)}, 25.0);
  EXPECT_EQ(plain->extremities().rows(), 0);
  EXPECT_EQ(extremity_vote(*plain, paths_to({5}, Eigen::VectorXd::Ones(1))).certainty[0], 0.0);
}

}  // namespace
}  // namespace sparse_mocap::retrieval
