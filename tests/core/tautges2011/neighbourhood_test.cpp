// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/neighbourhood.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap::tautges2011 {
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
  const auto weights = path_weights(with_rewards({18, 16, 13, 10}), WeightRule::linear, 99.0);
  EXPECT_LT((weights - Eigen::Vector4d(8, 6, 3, 0) / 17.0).norm(), 1e-12);
  const auto shifted = path_weights(with_rewards({36, 32, 26, 20}), WeightRule::linear, 1.0);
  EXPECT_LT((weights - shifted).norm(), 1e-12) << "neither shift nor scale matters";
}

TEST(PathWeights, OfEqualPathsAreEqual) {
  for (const WeightRule rule : {WeightRule::linear, WeightRule::softmax}) {
    EXPECT_LT((path_weights(with_rewards({3, 3, 3, 3}), rule, 2.0).array() - 0.25).matrix().norm(),
              1e-12);
    EXPECT_EQ(path_weights(with_rewards({-2}), rule, 2.0)[0], 1.0);
  }
}

// Rewards 5, 3, 1: mean 3, deviation sqrt(8 / 3).
TEST(PathWeights, OfASoftmaxFallWithTheDeviationOfRewards) {
  const auto weights = path_weights(with_rewards({5, 3, 1}), WeightRule::softmax, 1.5);
  const double step = std::exp(-1.5 * 2.0 / std::sqrt(8.0 / 3.0));
  const double total = 1.0 + step + step * step;
  EXPECT_LT((weights - Eigen::Vector3d(1.0, step, step * step) / total).norm(), 1e-12);
  const auto flat = path_weights(with_rewards({5, 3, 1}), WeightRule::softmax, 0.0);
  EXPECT_LT((flat.array() - 1.0 / 3.0).matrix().norm(), 1e-12);
}

// Two clips of ten frames; position row n of a clip is p + v n dt + a (n dt)^2 / 2.
class Gather : public ::testing::Test {
 protected:
  static constexpr double kDt = 0.04;

  Gather() {
    DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 10, 25.0),
                                          swaying_motion(template_skeleton(), 2, 10, 25.0)},
                                         25.0);
    for (int clip = 0; clip < 2; ++clip)
      for (int n = 0; n < 10; ++n)
        content.clip_rows[static_cast<std::size_t>(clip)].positions.row(n) =
            position(clip, n).transpose().cast<float>();
    database_ = database_of(content);
  }

  static Eigen::VectorXd velocity(int clip, double n) {
    return Eigen::VectorXd::LinSpaced(63, -1.0, 1.0 + clip).array() +
           acceleration(clip)[0] * n * kDt;
  }
  static Eigen::VectorXd acceleration(int clip) {
    return Eigen::VectorXd::Constant(63, 2.0 - 5.0 * clip);
  }
  static Eigen::VectorXd position(int clip, double n) {
    return Eigen::VectorXd::LinSpaced(63, 0.0, 1.0) + velocity(clip, 0.5 * n) * n * kDt;
  }

  std::shared_ptr<const MotionDatabase> database_;
};

TEST_F(Gather, FindsVelocitiesAndAccelerationsOfAParabolaInsideItsClip) {
  Eigen::VectorXd v(63), a(63);
  for (int clip = 0; clip < 2; ++clip) {
    for (int n = 0; n < 10; ++n) {
      kinematics_at(*database_, 10 * clip + n, v, a);
      const double centre = std::clamp(n, 1, 8);  // the ends take their neighbour's
      EXPECT_LT((v - velocity(clip, centre)).cwiseAbs().maxCoeff(), 1e-4);
      EXPECT_LT((a - acceleration(clip)).cwiseAbs().maxCoeff(), 1e-2);
    }
  }
}

TEST_F(Gather, LooksEveryQuantityUpAtItsFrame) {
  const std::vector<Path> paths{
      {13, 3.0, 2, 12}, {4, 2.0, 2, 2}, {10, 1.0, 1, -1}, {7, 1.0, 1, -1}};
  const Neighbourhood found =
      gather(*database_, {}, paths, Eigen::Vector4d(0.4, 0.3, 0.2, 0.1), nullptr);
  EXPECT_EQ(found.weights, Eigen::Vector4d(0.4, 0.3, 0.2, 0.1));
  const auto expect = [&](Eigen::Index i, int clip, double n, double before) {
    EXPECT_LT((found.positions.col(i) - position(clip, n)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((found.velocities.col(i) - velocity(clip, std::max(n, 1.0))).cwiseAbs().maxCoeff(),
              1e-4);
    EXPECT_LT((found.velocities_before.col(i) - velocity(clip, std::max(before, 1.0)))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-4);
    const double into = std::max(n, 1.0);
    EXPECT_LT((found.steps.col(i) - position(clip, into) + position(clip, into - 1.0))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6);
    EXPECT_LT((found.accelerations.col(i) - acceleration(clip)).cwiseAbs().maxCoeff(), 1e-2);
  };
  expect(0, 1, 3, 2);
  expect(1, 0, 4, 2);
  expect(2, 1, 0, 0);  // the first frame of a clip: nothing before it is used
  expect(3, 0, 7, 6);
}

TEST_F(Gather, PutsAnglesNearTheBestPathAndThatNearThePoseGiven) {
  DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 10, 25.0)}, 25.0);
  for (int n = 0; n < 10; ++n)
    content.clip_rows[0].angles.row(n).setConstant(
        static_cast<float>(0.1 + 0.01 * n + 2.0 * kPi * (n % 3 - 1)));
  const auto database = database_of(content);
  const Eigen::VectorXd near = Eigen::VectorXd::Constant(43, 4.0 * kPi);
  std::vector<Path> paths;
  for (int n = 0; n < 10; ++n) paths.push_back({n, 1.0, 1, -1});
  const auto found = gather(*database, {}, paths, Eigen::VectorXd::Constant(10, 0.1), &near);
  for (int n = 0; n < 10; ++n)
    EXPECT_LT((found.angles.col(n).array() - 4.0 * kPi - 0.1 - 0.01 * n).abs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
