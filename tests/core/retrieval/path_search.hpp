// SPDX-License-Identifier: GPL-3.0-or-later
//
// All paths of a small lazy neighbourhood graph, one after another.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sparse_mocap/retrieval/olng.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {

struct SearchProblem {
  std::vector<std::int32_t> clip_of_frame;
  std::vector<std::vector<retrieval::Neighbour>> columns;
  retrieval::OlngConfig config;

  // What matching this node earns.
  double own(std::size_t column, std::size_t node) const {
    return config.penalty * double{columns[column].back().distance} -
           double{columns[column][node].distance};
  }
  std::vector<std::pair<int, int>> steps() const {
    if (!config.is_warping) return {{1, 1}};
    return {{1, 1}, {1, 2}, {2, 1}};
  }
  // The node that a step from this one meets, -1 if there is none; direction 1 looks back.
  int met(std::size_t column, std::size_t node, std::pair<int, int> step, int direction) const {
    const auto other = static_cast<std::ptrdiff_t>(column) - direction * step.first;
    if (other < 0 || other >= static_cast<std::ptrdiff_t>(columns.size())) return -1;
    const int frame = columns[column][node].row;
    const int wanted = frame - direction * step.second;
    const auto& candidates = columns[static_cast<std::size_t>(other)];
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (candidates[i].row == wanted && clip_of_frame[static_cast<std::size_t>(wanted)] ==
                                             clip_of_frame[static_cast<std::size_t>(frame)])
        return static_cast<int>(i);
    return -1;
  }
};

struct BestPath {
  double reward = -std::numeric_limits<double>::infinity();
  int length = 0;
  int previous_frame = -1;
};

// Walks on from a node; sum and weight are those of the path so far without the node.
inline void walk(const SearchProblem& problem, std::size_t column, std::size_t node, int direction,
                 double sum, double weight, int length, int previous_frame, BestPath& best) {
  sum += weight * problem.own(column, node);
  ++length;
  if (length == 2) previous_frame = problem.columns[column][node].row;
  if (sum > best.reward) best = {sum, length, previous_frame};
  for (const auto& step : problem.steps()) {
    const int next = problem.met(column, node, step, direction);
    if (next < 0) continue;
    const auto next_column =
        static_cast<std::size_t>(static_cast<std::ptrdiff_t>(column) - direction * step.first);
    walk(problem, next_column, static_cast<std::size_t>(next), direction, sum,
         weight * std::pow(problem.config.forgetting, step.first), length, previous_frame, best);
  }
}

// The best of all paths that end in a node; direction -1: that begin there.
inline BestPath exhaustive_search(const SearchProblem& problem, std::size_t column,
                                  std::size_t node, int direction = 1) {
  BestPath best;
  walk(problem, column, node, direction, 0.0, 1.0, 0, -1, best);
  return best;
}

// For each node the path that extends the best windowed path before it, kept as a list of columns
// and what they earned; its worth is what lies in the last M columns.
inline std::vector<std::vector<BestPath>> windowed_search(const SearchProblem& problem) {
  using Earned = std::vector<std::pair<std::size_t, double>>;
  std::vector<std::vector<BestPath>> found;
  std::vector<std::vector<Earned>> earned;
  const auto window = static_cast<std::size_t>(problem.config.window);
  for (std::size_t t = 0; t < problem.columns.size(); ++t) {
    found.emplace_back();
    earned.emplace_back();
    for (std::size_t i = 0; i < problem.columns[t].size(); ++i) {
      BestPath path{0.0, 0, -1};
      Earned list;
      for (const auto& step : problem.steps()) {
        const int before = problem.met(t, i, step, 1);
        if (before < 0) continue;
        const auto at = static_cast<std::size_t>(before);
        const std::size_t column = t - static_cast<std::size_t>(step.first);
        if (found[column][at].reward <= path.reward) continue;
        path = {found[column][at].reward, 0, problem.columns[column][at].row};
        list = earned[column][at];
      }
      list.emplace_back(t, problem.own(t, i));
      path.reward = 0.0;
      for (const auto& [column, reward] : list) {
        if (column + window <= t) continue;
        path.reward += reward;
        ++path.length;
      }
      found[t].push_back(path);
      earned[t].push_back(list);
    }
  }
  return found;
}

// Columns of k different frames with random distances, ascending; clips of the given lengths.
inline SearchProblem random_problem(Random& random, int frames, int columns, int k,
                                    const std::vector<int>& clip_lengths,
                                    const retrieval::OlngConfig& config) {
  SearchProblem problem;
  problem.config = config;
  for (std::size_t c = 0; c < clip_lengths.size(); ++c)
    problem.clip_of_frame.insert(problem.clip_of_frame.end(),
                                 static_cast<std::size_t>(clip_lengths[c]),
                                 static_cast<std::int32_t>(c));
  for (int t = 0; t < columns; ++t) {
    std::vector<int> rows;
    for (int f = 0; f < frames; ++f) rows.push_back(f);
    std::vector<retrieval::Neighbour> column;
    for (int i = 0; i < k; ++i) {
      const int pick = i + random.below(frames - i);
      std::swap(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(pick)]);
      column.push_back(
          {static_cast<float>(random.in(0.1, 3.0)), rows[static_cast<std::size_t>(i)]});
    }
    std::sort(column.begin(), column.end());
    problem.columns.push_back(column);
  }
  return problem;
}

}  // namespace sparse_mocap::testing
