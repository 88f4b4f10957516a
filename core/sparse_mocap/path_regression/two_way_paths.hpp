// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/olng.hpp"

namespace sparse_mocap::path_regression {

// Paths that know both what came before a frame and what comes after it: one pass over the online
// lazy neighbourhood graph in each direction, rewards added.
class TwoWayPaths {
 public:
  TwoWayPaths(const std::vector<std::int32_t>& clip_of_frame, const retrieval::OlngConfig& config);

  // columns[t] holds the neighbours of reading t, as KnnIndex::search gives them. Of each reading
  // the num_paths best paths are kept. reached is called on the way, and may throw.
  void run(
      std::span<const std::vector<retrieval::Neighbour>> columns, int num_paths,
      const std::function<void()>& reached = [] {});
  // The best paths through the neighbours of reading t, one a neighbour, the best first.
  const std::vector<retrieval::Path>& paths(std::size_t t) const { return paths_[t]; }

 private:
  retrieval::OnlineLazyNeighbourhoodGraph forward_;
  retrieval::OnlineLazyNeighbourhoodGraph backward_;  // on the database played backwards
  int last_frame_;
  retrieval::OlngConfig config_;
  std::vector<std::vector<retrieval::Path>> paths_;
};

}  // namespace sparse_mocap::path_regression
