// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/two_way_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "retrieval/path_search.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using retrieval::OlngConfig;
using retrieval::Path;
using testing::exhaustive_search;
using testing::Random;
using testing::random_problem;
using testing::SearchProblem;

constexpr int kAll = 1000;

const Path& path_to(const std::vector<Path>& paths, int frame) {
  return *std::find_if(paths.begin(), paths.end(),
                       [&](const Path& path) { return path.frame == frame; });
}

TEST(TwoWayPaths, FindsTheBestPathThroughEveryNode) {
  Random random(1);
  for (const double penalty : {0.7, 1.05}) {
    for (int trial = 0; trial < 10; ++trial) {
      OlngConfig config;
      config.penalty = penalty;
      config.forgetting = trial % 2 == 0 ? 0.9 : 1.0;
      const SearchProblem problem = random_problem(random, 14, 7, 6, {5, 6, 3}, config);
      TwoWayPaths retrieval(problem.clip_of_frame, config);
      retrieval.run(problem.columns, kAll);
      for (std::size_t t = 0; t < problem.columns.size(); ++t) {
        ASSERT_EQ(retrieval.paths(t).size(), problem.columns[t].size());
        for (std::size_t i = 0; i < problem.columns[t].size(); ++i) {
          const auto before = exhaustive_search(problem, t, i);
          const auto after = exhaustive_search(problem, t, i, -1);
          const Path& path = path_to(retrieval.paths(t), problem.columns[t][i].row);
          EXPECT_NEAR(path.reward, before.reward + after.reward - problem.own(t, i), 1e-4);
          EXPECT_EQ(path.length, before.length + after.length - 1);
          EXPECT_EQ(path.previous_frame, before.previous_frame);
        }
      }
    }
  }
}

TEST(TwoWayPaths, KeepsTheBestPaths) {
  Random random(3);
  const SearchProblem problem = random_problem(random, 14, 7, 6, {5, 6, 3}, {});
  TwoWayPaths all(problem.clip_of_frame, {}), best(problem.clip_of_frame, {});
  all.run(problem.columns, kAll);
  best.run(problem.columns, 2);
  for (std::size_t t = 0; t < problem.columns.size(); ++t) {
    ASSERT_EQ(best.paths(t).size(), 2U);
    for (std::size_t i = 0; i < all.paths(t).size(); ++i) {
      const double reward = all.paths(t)[i].reward;
      if (i < 2) {
        EXPECT_EQ(best.paths(t)[i].reward, reward);
      }
      EXPECT_LE(reward, best.paths(t)[0].reward);
    }
  }
}

TEST(TwoWayPaths, MayRunAgainAndWithEmptyColumns) {
  Random random(2);
  SearchProblem problem = random_problem(random, 14, 5, 6, {14}, {});
  TwoWayPaths retrieval(problem.clip_of_frame, {});
  retrieval.run(problem.columns, kAll);
  const double first = retrieval.paths(2)[0].reward;
  retrieval.run(problem.columns, kAll);
  EXPECT_EQ(retrieval.paths(2)[0].reward, first);
  problem.columns[2].clear();
  retrieval.run(problem.columns, kAll);
  EXPECT_TRUE(retrieval.paths(2).empty());
}

TEST(TwoWayPaths, AsksOnTheWayInBothDirectionsWhetherToGoOn) {
  const std::vector<std::vector<retrieval::Neighbour>> columns(200, {{0.5F, 3}});
  TwoWayPaths retrieval(std::vector<std::int32_t>(10, 0), {});
  int asked = 0;
  retrieval.run(columns, 1, [&] { ++asked; });
  EXPECT_GE(asked, 6);
  const auto cancel_at = [&](int last) {
    asked = 0;
    retrieval.run(columns, 1, [&] {
      if (++asked == last) throw Cancelled();
    });
  };
  for (const int last : {1, 3, 6}) EXPECT_THROW(cancel_at(last), Cancelled);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
