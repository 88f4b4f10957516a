// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/whole_take.hpp"

#include <utility>

#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/path_regression/two_way_paths.hpp"

namespace sparse_mocap::path_regression {
namespace {

retrieval::FeatureRows signal_rows(const std::vector<Reading>& take,
                                   const std::vector<retrieval::Signal>& signals) {
  retrieval::FeatureRows rows(static_cast<Eigen::Index>(take.size()),
                              static_cast<Eigen::Index>(3 * signals.size()));
  for (std::size_t t = 0; t < take.size(); ++t)
    rows.row(static_cast<Eigen::Index>(t)) = retrieval::signal_row(take[t], signals);
  return rows;
}

}  // namespace

// The whole take in one fit.
std::vector<PoseEstimate> WholeTakeReconstructor::fitted(
    const std::vector<Reading>& take, std::vector<RetrievedFrame> retrieved) const {
  std::vector<FittedFrame> frames;
  std::vector<FrameTarget> targets;
  for (auto& frame : retrieved) {
    targets.push_back(std::move(frame.target));
    frames.push_back(start_of(skeleton(), 1.0 / rate_hz(), targets.back(),
                              frames.empty() ? nullptr : &frames.back()));
  }
  const Config& config = solver_.config();
  TakeFit(skeleton(), 1.0 / rate_hz(), config.fit).fit(frames, targets, 0, config.max_iterations);
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < frames.size(); ++t)
    estimates.push_back(to_estimate(frames[t], take[t].time_s, targets[t].feet.certainty,
                                    std::move(retrieved[t].diagnostics)));
  return estimates;
}

std::vector<PoseEstimate> WholeTakeReconstructor::solve(const std::vector<Reading>& take,
                                                        const Progress& progress) {
  for (const auto& reading : take) require_sensors(reading, solver_.num_sensors());
  const retrieval::FeatureRows signals = signal_rows(take, solver_.signals());
  const auto window = [&](std::size_t t) {
    return retrieval::SignalWindow{signals, 0, signals.rows(), static_cast<Eigen::Index>(t)};
  };
  std::vector<std::vector<retrieval::Neighbour>> columns(take.size());
  for (std::size_t t = 0; t < take.size(); ++t) {
    progress.report(t, 2 * take.size(), "searching");
    solver_.search(window(t), columns[t]);
  }
  const Config& config = solver_.config();
  TwoWayPaths paths(retrieval::clips_of_frames(solver_.database()),
                    {config.penalty, config.forgetting});
  paths.run(columns);
  std::vector<RetrievedFrame> retrieved;
  for (std::size_t t = 0; t < take.size(); ++t) {
    progress.report(take.size() + t, 2 * take.size(), "reconstructing");
    retrieved.push_back(solver_.retrieve(paths.paths(t), window(t), take[t]));
  }
  return fitted(take, std::move(retrieved));
}

}  // namespace sparse_mocap::path_regression
