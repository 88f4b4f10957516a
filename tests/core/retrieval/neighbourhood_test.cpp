// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/neighbourhood.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::content_of;
using testing::database_of;
using testing::swaying_motion;
using testing::template_skeleton;

std::vector<Path> with_rewards(const std::vector<double>& rewards) {
  std::vector<Path> paths;
  for (std::size_t i = 0; i < rewards.size(); ++i)
    paths.push_back({static_cast<int>(i), rewards[i], 1, -1});
  return paths;
}

TEST(BestPaths, AreThoseOfGreatestRewardTiesByFrame) {
  const auto frames_of = [](int count) {
    std::vector<int> frames;
    for (const Path& path : best_paths(with_rewards({1, 5, 3, 5, 0, 3}), count))
      frames.push_back(path.frame);
    return frames;
  };
  EXPECT_EQ(frames_of(1), (std::vector<int>{1}));
  EXPECT_EQ(frames_of(3), (std::vector<int>{1, 3, 2}));
  EXPECT_EQ(frames_of(100), (std::vector<int>{1, 3, 2, 5, 0, 4}));
  EXPECT_TRUE(best_paths({}, 3).empty());
}

// Costs 2, 4, 7, 10 are rewards of 20 less these: (10 - c) / (8 + 6 + 3 + 0).
TEST(PathWeights, AreEquationOne) {
  const auto weights = linear_weights(with_rewards({18, 16, 13, 10}));
  EXPECT_LT((weights - Eigen::Vector4d(8, 6, 3, 0) / 17.0).norm(), 1e-12);
  const auto shifted = linear_weights(with_rewards({36, 32, 26, 20}));
  EXPECT_LT((weights - shifted).norm(), 1e-12) << "neither shift nor scale matters";
}

TEST(PathWeights, OfEqualPathsAreEqual) {
  const auto equal = with_rewards({3, 3, 3, 3}), one = with_rewards({-2});
  for (const auto& weights : {linear_weights(equal), softmax_weights(equal, 2.0)})
    EXPECT_LT((weights.array() - 0.25).matrix().norm(), 1e-12);
  for (const auto& weights : {linear_weights(one), softmax_weights(one, 2.0)})
    EXPECT_EQ(weights[0], 1.0);
}

// Rewards 5, 3, 1: mean 3, deviation sqrt(8 / 3).
TEST(PathWeights, OfASoftmaxFallWithTheDeviationOfRewards) {
  const auto weights = softmax_weights(with_rewards({5, 3, 1}), 1.5);
  const double step = std::exp(-1.5 * 2.0 / std::sqrt(8.0 / 3.0));
  const double total = 1.0 + step + step * step;
  EXPECT_LT((weights - Eigen::Vector3d(1.0, step, step * step) / total).norm(), 1e-12);
  const auto flat = softmax_weights(with_rewards({5, 3, 1}), 0.0);
  EXPECT_LT((flat.array() - 1.0 / 3.0).matrix().norm(), 1e-12);
}

TEST(Gather, LooksPosesUpAtTheirFrames) {
  const auto database = database_of({swaying_motion(template_skeleton(), 1, 10, 25.0),
                                     swaying_motion(template_skeleton(), 2, 10, 25.0)});
  const std::vector<Path> paths{{13, 3.0, 2, 12}, {4, 2.0, 2, 2}, {10, 1.0, 1, -1}};
  const Neighbourhood found = gather(*database, paths, Eigen::Vector3d(0.5, 0.3, 0.2), nullptr);
  EXPECT_EQ(found.weights, Eigen::Vector3d(0.5, 0.3, 0.2));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const int frame = paths[static_cast<std::size_t>(i)].frame;
    EXPECT_EQ(Eigen::VectorXf(found.positions.col(i).cast<float>()),
              Eigen::VectorXf(database->positions().row(frame).transpose()));
    JointTransforms retrieved, stored;
    const Eigen::VectorXd angles = database->angles().row(frame).transpose().cast<double>();
    forward_kinematics(database->skeleton(), Vec3::Zero(), found.angles.col(i), retrieved);
    forward_kinematics(database->skeleton(), Vec3::Zero(), angles, stored);
    EXPECT_LT((stacked_ends(retrieved) - stacked_ends(stored)).norm(), 1e-9);
  }
  EXPECT_EQ(clip_at(*database, 13).name, "clip1");
  EXPECT_EQ(clips_of_frames(*database)[9], 0);
  EXPECT_EQ(clips_of_frames(*database)[10], 1);
}

TEST(Gather, PutsAnglesNearTheBestPathAndThatNearThePoseGiven) {
  DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 10, 25.0)}, 25.0);
  testing::change_rows(content, 0, [](DatabaseRows& rows) {
    for (int n = 0; n < 10; ++n)
      rows.angles.row(n).setConstant(0.125F + static_cast<float>(n) / 64.0F);
  });
  const auto database = database_of(content);
  const Eigen::VectorXd near = Eigen::VectorXd::Constant(43, 4.0 * kPi);
  std::vector<Path> paths;
  for (int n = 0; n < 10; ++n) paths.push_back({n, 1.0, 1, -1});
  const auto found = gather(*database, paths, Eigen::VectorXd::Constant(10, 0.1), &near);
  for (int n = 0; n < 10; ++n)
    EXPECT_LT((found.angles.col(n).array() - 4.0 * kPi - 0.125 - n / 64.0).abs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace sparse_mocap::retrieval
