// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/offline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"
#include "tautges2011/path_search.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::exhaustive_search;
using testing::Random;
using testing::random_problem;
using testing::SearchProblem;

TEST(TwoWayRetrieval, FindsTheBestPathThroughEveryNode) {
  Random random(1);
  for (const double penalty : {0.7, 1.05}) {
    for (int trial = 0; trial < 10; ++trial) {
      OlngConfig config;
      config.penalty = penalty;
      config.forgetting = trial % 2 == 0 ? 0.9 : 1.0;
      const SearchProblem problem = random_problem(random, 14, 7, 6, {5, 6, 3}, config);
      TwoWayRetrieval retrieval(problem.clip_of_frame, config);
      retrieval.run(problem.columns);
      for (std::size_t t = 0; t < problem.columns.size(); ++t) {
        for (std::size_t i = 0; i < problem.columns[t].size(); ++i) {
          const auto before = exhaustive_search(problem, t, i);
          const auto after = exhaustive_search(problem, t, i, -1);
          const Path& path = retrieval.paths(t)[i];
          EXPECT_EQ(path.frame, problem.columns[t][i].row);
          EXPECT_NEAR(path.reward, before.reward + after.reward - problem.own(t, i), 1e-4);
          EXPECT_EQ(path.length, before.length + after.length - 1);
          EXPECT_EQ(path.previous_frame, before.previous_frame);
        }
      }
    }
  }
}

TEST(TwoWayRetrieval, MayRunAgainAndWithEmptyColumns) {
  Random random(2);
  SearchProblem problem = random_problem(random, 14, 5, 6, {14}, {});
  TwoWayRetrieval retrieval(problem.clip_of_frame, {});
  retrieval.run(problem.columns);
  const double first = retrieval.paths(2)[0].reward;
  retrieval.run(problem.columns);
  EXPECT_EQ(retrieval.paths(2)[0].reward, first);
  problem.columns[2].clear();
  retrieval.run(problem.columns);
  EXPECT_TRUE(retrieval.paths(2).empty());
}

// A take whose first angle and root sway at so many Hz, on a database at 25 Hz.
std::vector<PoseEstimate> swaying_take(const MotionDatabase& database, double frequency_hz) {
  std::vector<PoseEstimate> take(100);
  for (std::size_t t = 0; t < take.size(); ++t) {
    const double s = std::sin(2.0 * kPi * frequency_hz * static_cast<double>(t) / 25.0);
    take[t].angles = Eigen::VectorXd::Constant(database.skeleton().num_angles(), 0.1);
    take[t].angles[0] += s;
    // A full turn that says nothing must not be averaged.
    take[t].angles[5] += 2.0 * kPi * static_cast<double>(t % 3);
    take[t].positions = Eigen::VectorXd::Zero(3 * kNumStandardJoints);
    take[t].root_position = {s, 1.0, 0.0};
    take[t].yaw_rad = s;
    take[t].clip = static_cast<int>(t);
  }
  return take;
}

class SmoothedTake : public ::testing::Test {
 protected:
  const std::shared_ptr<const MotionDatabase> database_ =
      testing::database_of({testing::resting_motion(testing::template_skeleton(), 20, 25.0)});

  std::vector<PoseEstimate> smoothed(double frequency_hz, double sigma_s) const {
    Config config;
    config.offline_smoothing_s = sigma_s;
    return smoothed_take(swaying_take(*database_, frequency_hz), *database_, config);
  }
};

TEST_F(SmoothedTake, IsTheTakeItselfWithoutSmoothing) {
  const auto take = smoothed(3.0, 0.0);
  const auto plain = swaying_take(*database_, 3.0);
  for (std::size_t t = 0; t < take.size(); ++t) EXPECT_EQ(take[t].angles, plain[t].angles);
  EXPECT_TRUE(smoothed_take({}, *database_, {}).empty());
}

TEST_F(SmoothedTake, KeepsSlowMovementsInTimeAndTakesFastOnesAway) {
  const auto slow = smoothed(0.25, 0.08), fast = smoothed(8.0, 0.08);
  for (std::size_t t = 10; t < 90; ++t) {
    const double s = std::sin(2.0 * kPi * 0.25 * static_cast<double>(t) / 25.0);
    EXPECT_NEAR(slow[t].angles[0], 0.1 + s, 0.02);
    EXPECT_NEAR(slow[t].root_position.x(), s, 0.02);
    EXPECT_NEAR(slow[t].yaw_rad, s, 0.02);
    EXPECT_NEAR(fast[t].angles[0], 0.1, 0.02);
    EXPECT_NEAR(std::remainder(slow[t].angles[5] - 0.1, 2.0 * kPi), 0.0, 1e-9);
    EXPECT_EQ(slow[t].clip, static_cast<int>(t));
  }
}

TEST_F(SmoothedTake, HasThePositionsOfItsAngles) {
  JointTransforms pose;
  for (const auto& estimate : smoothed(1.0, 0.08)) {
    forward_kinematics(database_->skeleton(), Vec3::Zero(), estimate.angles, pose);
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      EXPECT_LT(
          (estimate.positions.segment<3>(3 * j) - pose.end[static_cast<std::size_t>(j)]).norm(),
          1e-12);
  }
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
