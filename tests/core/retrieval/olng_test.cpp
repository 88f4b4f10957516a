// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/olng.hpp"

#include <gtest/gtest.h>

#include "retrieval/path_search.hpp"

namespace sparse_mocap::retrieval {
namespace {

using testing::BestPath;
using testing::exhaustive_search;
using testing::Random;
using testing::random_problem;
using testing::SearchProblem;

// Feeds the problem's columns and compares each with what the exhaustive search says.
void expect_exhaustive_optimum(const SearchProblem& problem) {
  OnlineLazyNeighbourhoodGraph graph(problem.clip_of_frame, problem.config);
  for (std::size_t t = 0; t < problem.columns.size(); ++t) {
    graph.extend(problem.columns[t]);
    ASSERT_EQ(graph.paths().size(), problem.columns[t].size());
    for (std::size_t i = 0; i < graph.paths().size(); ++i) {
      const Path& path = graph.paths()[i];
      const BestPath best = exhaustive_search(problem, t, i);
      EXPECT_EQ(path.frame, problem.columns[t][i].row);
      EXPECT_NEAR(path.reward, best.reward, 1e-4);
      EXPECT_EQ(path.length, best.length);
      EXPECT_EQ(path.previous_frame, best.previous_frame);
    }
  }
}

// Penalties are not 1: then the farthest neighbour earns nothing, and a way through it ties.
OlngConfig configured(double penalty, double forgetting, bool is_warping = true) {
  OlngConfig config;
  config.penalty = penalty;
  config.forgetting = forgetting;
  config.is_warping = is_warping;
  return config;
}

TEST(Olng, PathsAreTheBestOfAllPossibleOnes) {
  Random random(1);
  for (const double penalty : {0.6, 1.05, 1.5})
    for (const double forgetting : {0.5, 0.95, 1.0})
      for (int trial = 0; trial < 8; ++trial)
        expect_exhaustive_optimum(
            random_problem(random, 14, 7, 6, {14}, configured(penalty, forgetting)));
}

TEST(Olng, PathsNeverCrossClipBorders) {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial)
    expect_exhaustive_optimum(
        random_problem(random, 14, 7, 8, {3, 4, 5, 2}, configured(1.05, 0.95)));
}

TEST(Olng, GoesAtTheDatabasesSpeedOnlyWithoutWarping) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial)
    expect_exhaustive_optimum(
        random_problem(random, 14, 8, 7, {7, 7}, configured(1.05, 0.9, false)));
}

TEST(Olng, PathsMayGoAtHalfAndAtDoubleSpeed) {
  OnlineLazyNeighbourhoodGraph graph(std::vector<std::int32_t>(20, 0), configured(1.0, 1.0));
  // Double speed: frames 0, 2, 4; then half: 5 two columns later. Frame 9 is always the farthest.
  const std::vector<std::vector<int>> matched{{0}, {2}, {4}, {}, {5}};
  for (const auto& column : matched) {
    std::vector<Neighbour> neighbours;
    for (const int frame : column) neighbours.push_back({0.25F, frame});
    neighbours.push_back({1.0F, 19});
    graph.extend(neighbours);
  }
  EXPECT_EQ(graph.paths()[0].frame, 5);
  EXPECT_EQ(graph.paths()[0].length, 4);
  EXPECT_EQ(graph.paths()[0].previous_frame, 4);
  EXPECT_NEAR(graph.paths()[0].reward, 4 * 0.75, 1e-6);
}

TEST(Olng, SkipsNeitherTwoColumnsNorTwoFrames) {
  const auto reward_after = [](const std::vector<std::vector<int>>& columns) {
    OnlineLazyNeighbourhoodGraph graph(std::vector<std::int32_t>(20, 0), configured(1.0, 1.0));
    for (const auto& column : columns) {
      std::vector<Neighbour> neighbours;
      for (const int frame : column) neighbours.push_back({0.0F, frame});
      neighbours.push_back({1.0F, 19});
      graph.extend(neighbours);
    }
    return graph.paths()[0].length;
  };
  EXPECT_EQ(reward_after({{3}, {4}}), 2);
  EXPECT_EQ(reward_after({{3}, {5}}), 2);
  EXPECT_EQ(reward_after({{3}, {6}}), 1);
  EXPECT_EQ(reward_after({{3}, {3}}), 1) << "strictly monotonous";
  EXPECT_EQ(reward_after({{3}, {2}}), 1);
  EXPECT_EQ(reward_after({{3}, {}, {4}}), 2);
  EXPECT_EQ(reward_after({{3}, {}, {5}}), 1) << "(2,2) is no step of its own";
  EXPECT_EQ(reward_after({{3}, {}, {}, {4}}), 1);
}

// In a window a path is worth what it matched in the last M columns, however long it is.
TEST(Olng, PathsReachBackAtMostTheWindow) {
  Random random(4);
  for (const int window : {1, 2, 3, 4, 7}) {
    for (int trial = 0; trial < 60; ++trial) {
      OlngConfig config = configured(trial % 2 == 0 ? 1.05 : 1.3, 1.0);
      config.window = window;
      const SearchProblem problem = random_problem(random, 12, 12, 2 + trial % 7, {12}, config);
      const auto expected = testing::windowed_search(problem);
      OnlineLazyNeighbourhoodGraph graph(problem.clip_of_frame, config);
      for (std::size_t t = 0; t < problem.columns.size(); ++t) {
        graph.extend(problem.columns[t]);
        for (std::size_t i = 0; i < graph.paths().size(); ++i) {
          const Path& path = graph.paths()[i];
          EXPECT_NEAR(path.reward, expected[t][i].reward, 1e-4)
              << "M " << window << " column " << t;
          EXPECT_EQ(path.length, expected[t][i].length) << "M " << window << " column " << t;
          EXPECT_EQ(path.previous_frame, expected[t][i].previous_frame);
        }
      }
    }
  }
}

TEST(Olng, ForgetsEverythingAtAReset) {
  Random random(5);
  for (const int window : {0, 3}) {
    OlngConfig config = configured(1.0, window == 0 ? 0.95 : 1.0);
    config.window = window;
    const SearchProblem problem = random_problem(random, 14, 6, 6, {7, 7}, config);
    OnlineLazyNeighbourhoodGraph used(problem.clip_of_frame, config);
    for (int repeat = 0; repeat < 4; ++repeat) {
      OnlineLazyNeighbourhoodGraph fresh(problem.clip_of_frame, config);
      used.reset();
      EXPECT_TRUE(used.paths().empty());
      for (int t = 0; t <= repeat + 1; ++t) {
        used.extend(problem.columns[static_cast<std::size_t>(t)]);
        fresh.extend(problem.columns[static_cast<std::size_t>(t)]);
        for (std::size_t i = 0; i < fresh.paths().size(); ++i) {
          EXPECT_EQ(used.paths()[i].reward, fresh.paths()[i].reward);
          EXPECT_EQ(used.paths()[i].length, fresh.paths()[i].length);
        }
      }
    }
  }
}

TEST(Olng, BeginsAnewAfterColumnsWithoutNeighbours) {
  OnlineLazyNeighbourhoodGraph graph(std::vector<std::int32_t>(5, 0), configured(1.0, 1.0));
  const std::vector<Neighbour> first{{0.5F, 1}, {1.0F, 4}}, second{{0.5F, 2}, {1.0F, 4}};
  graph.extend(first);
  graph.extend({});
  EXPECT_TRUE(graph.paths().empty());
  graph.extend({});
  graph.extend(second);
  EXPECT_EQ(graph.paths()[0].length, 1);
}

}  // namespace
}  // namespace sparse_mocap::retrieval
