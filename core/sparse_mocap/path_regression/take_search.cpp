// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/take_search.hpp"

namespace sparse_mocap::path_regression {

retrieval::FeatureRows signal_rows(const std::vector<Reading>& take,
                                   const std::vector<retrieval::Signal>& signals) {
  retrieval::FeatureRows rows(static_cast<Eigen::Index>(take.size()),
                              static_cast<Eigen::Index>(3 * signals.size()));
  for (std::size_t t = 0; t < take.size(); ++t)
    rows.row(static_cast<Eigen::Index>(t)) = retrieval::signal_row(take[t], signals);
  return rows;
}

retrieval::SignalWindow window_at(const retrieval::FeatureRows& signals, std::size_t reading) {
  return {signals, 0, signals.rows(), static_cast<Eigen::Index>(reading)};
}

TwoWayPaths paths_of(const FrameSolver& solver, const retrieval::FeatureRows& signals,
                     int num_threads, const std::function<void(std::size_t)>& at) {
  using Neighbours = std::vector<retrieval::Neighbour>;
  const auto count = static_cast<std::size_t>(signals.rows());
  const auto columns = in_parallel<Neighbours>(count, num_threads, at, [&](std::size_t t) {
    Neighbours found;
    solver.search(window_at(signals, t), found);
    return found;
  });
  const Config& config = solver.config();
  TwoWayPaths paths(retrieval::clips_of_frames(solver.database()),
                    {config.penalty, config.forgetting});
  paths.run(columns, config.num_paths, [&] { at(count); });
  return paths;
}

}  // namespace sparse_mocap::path_regression
