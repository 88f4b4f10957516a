// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sparse_mocap/database/index.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/method.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/olng.hpp"

namespace sparse_mocap::tautges2011 {

// Paths that know both what came before a frame and what comes after it: one pass over the online
// lazy neighbourhood graph in each direction, rewards added.
class TwoWayRetrieval {
 public:
  TwoWayRetrieval(const std::vector<std::int32_t>& clip_of_frame, const OlngConfig& config);

  // columns[t] holds the neighbours of reading t, as KnnIndex::search gives them.
  void run(std::span<const std::vector<Neighbour>> columns);
  // For each neighbour of reading t the best path through it.
  const std::vector<Path>& paths(std::size_t t) const { return paths_[t]; }

 private:
  OnlineLazyNeighbourhoodGraph forward_;
  OnlineLazyNeighbourhoodGraph backward_;  // on the database played backwards
  int last_frame_;
  OlngConfig config_;
  std::vector<std::vector<Path>> paths_;
};

// Poses and root motion through a zero-phase low-pass of config.offline_smoothing_s; contacts, fit
// and retrieval as they are.
std::vector<PoseEstimate> smoothed_take(const std::vector<PoseEstimate>& estimates,
                                        const MotionDatabase& database, const Config& config);

}  // namespace sparse_mocap::tautges2011
