// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/path_regression/frame_solver.hpp"
#include "sparse_mocap/path_regression/two_way_paths.hpp"

namespace sparse_mocap::path_regression {

// of(i) for each i < count, worked out on so many threads (0: one a processor); at(i) is called on
// this one on the way, and may throw.
template <typename Result, typename At, typename Of>
std::vector<Result> in_parallel(std::size_t count, int num_threads, const At& at, const Of& of) {
  constexpr std::size_t kPiece = 16;  // frames
  std::vector<Result> results(count);
  const auto work = [&](std::size_t piece, const std::stop_token&) {
    const std::size_t begin = piece * kPiece, end = std::min(count, begin + kPiece);
    for (std::size_t i = begin; i < end; ++i) results[i] = of(i);
    return piece;
  };
  work_in_order((count + kPiece - 1) / kPiece, num_threads, work, [](std::size_t, std::size_t) {},
                [&](std::size_t p) { at(p * kPiece); });
  return results;
}

// The signals of a take's readings, a row each.
retrieval::FeatureRows signal_rows(const std::vector<Reading>& take,
                                   const std::vector<retrieval::Signal>& signals);
retrieval::SignalWindow window_at(const retrieval::FeatureRows& signals, std::size_t reading);

// The paths through the database that these signals lead along. at(number of readings that are
// searched) is called on the way, and may throw.
TwoWayPaths paths_of(const FrameSolver& solver, const retrieval::FeatureRows& signals,
                     int num_threads, const std::function<void(std::size_t)>& at);

}  // namespace sparse_mocap::path_regression
