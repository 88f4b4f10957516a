// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/whole_take.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sparse_mocap/base/ordered_work.hpp"
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

// of(i) for each i < count, worked out on all threads; reached(i) is called on this one on the way.
template <typename Result, typename Reached, typename Of>
std::vector<Result> WholeTakeReconstructor::in_parallel(std::size_t count, const Reached& reached,
                                                        const Of& of) const {
  constexpr std::size_t kPiece = 16;  // frames
  std::vector<Result> results(count);
  const auto work = [&](std::size_t piece, const std::stop_token&) {
    const std::size_t begin = piece * kPiece, end = std::min(count, begin + kPiece);
    for (std::size_t i = begin; i < end; ++i) results[i] = of(i);
    return piece;
  };
  work_in_order((count + kPiece - 1) / kPiece, num_threads_, work, [](std::size_t, std::size_t) {},
                [&](std::size_t p) { reached(p * kPiece); });
  return results;
}

// The whole take in one fit.
std::vector<PoseEstimate> WholeTakeReconstructor::fitted(const std::vector<Reading>& take,
                                                         std::vector<RetrievedFrame> retrieved,
                                                         const Progress& progress) const {
  constexpr double kEvened_s = 0.08;
  std::vector<FittedFrame> frames;
  std::vector<FrameTarget> targets;
  for (auto& frame : retrieved) {
    targets.push_back(std::move(frame.target));
    frames.push_back(start_of(skeleton(), 1.0 / rate_hz(), targets.back(),
                              frames.empty() ? nullptr : &frames.back()));
  }
  even_agreements(targets, static_cast<std::size_t>(std::lround(kEvened_s * rate_hz())));
  const Config& config = solver_.config();
  TakeFit(skeleton(), 1.0 / rate_hz(), config.fit, num_threads_)
      .fit(frames, targets, 0, config.max_iterations, progress);
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    estimates.push_back(to_estimate(frames[t], take[t].time_s, targets[t].feet.certainty,
                                    std::move(retrieved[t].diagnostics)));
    estimates.back().extremities = retrieved[t].extremities;
  }
  return estimates;
}

std::vector<PoseEstimate> WholeTakeReconstructor::solve(const std::vector<Reading>& measured,
                                                        const Progress& progress) {
  constexpr std::size_t kNumParts = 3;  // search, retrieval and fit take about as long
  for (const auto& reading : measured) require_sensors(reading, solver_.num_sensors());
  turning_.reset();
  std::vector<Reading> take;
  for (const auto& reading : measured) take.push_back(turning_(reading));
  const retrieval::FeatureRows signals = signal_rows(take, solver_.signals());
  const auto window = [&](std::size_t t) {
    return retrieval::SignalWindow{signals, 0, signals.rows(), static_cast<Eigen::Index>(t)};
  };
  using Neighbours = std::vector<retrieval::Neighbour>;
  std::vector<Neighbours> columns = in_parallel<Neighbours>(
      take.size(), [&](std::size_t t) { progress.report(t, kNumParts * take.size(), "searching"); },
      [&](std::size_t t) {
        Neighbours found;
        solver_.search(window(t), found);
        return found;
      });
  const Config& config = solver_.config();
  TwoWayPaths paths(retrieval::clips_of_frames(solver_.database()),
                    {config.penalty, config.forgetting});
  paths.run(columns, config.num_paths,
            [&] { progress.report(take.size(), kNumParts * take.size(), "searching"); });
  columns = {};
  auto retrieved = in_parallel<RetrievedFrame>(
      take.size(),
      [&](std::size_t t) {
        progress.report(take.size() + t, kNumParts * take.size(), "reconstructing");
      },
      [&](std::size_t t) {
        RetrievedFrame frame;
        solver_.retrieve(paths.paths(t), window(t), take[t], frame);
        return frame;
      });
  const Progress fitting(
      Progress::Callback([&](std::size_t done, std::size_t total, std::string_view what) {
        const std::size_t share = take.size() * done / total;
        progress.report(2 * take.size() + share, kNumParts * take.size(), what);
        return true;
      }));
  return fitted(take, std::move(retrieved), fitting);
}

}  // namespace sparse_mocap::path_regression
