// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/live.hpp"

#include "sparse_mocap/path_regression/banded_system.hpp"

namespace sparse_mocap::path_regression {

LiveReconstructor::LiveReconstructor(const Config& config, const MethodContext& context)
    : solver_(config, context),
      turning_(context.sensors),
      fit_(solver_.database().skeleton(), solver_.database().frame_time_s(), config.fit),
      graph_(retrieval::clips_of_frames(solver_.database()),
             {solver_.config().penalty, solver_.config().forgetting}),
      recent_(solver_.reach_back() + solver_.look_ahead() + 2,
              static_cast<Eigen::Index>(3 * solver_.signals().size())) {}

std::optional<PoseEstimate> LiveReconstructor::step(const Reading& measured) {
  require_sensors(measured, solver_.num_sensors());
  const Reading reading = turning_(measured);
  if (num_recent_ == recent_.rows()) {
    recent_.topRows(num_recent_ - 1) = recent_.bottomRows(num_recent_ - 1).eval();
    --num_recent_;
  }
  recent_.row(num_recent_++) = retrieval::signal_row(reading, solver_.signals());
  waiting_.push_back(reading);
  if (static_cast<int>(waiting_.size()) <= solver_.look_ahead()) return std::nullopt;
  return solve_next();
}

std::vector<PoseEstimate> LiveReconstructor::flush() {
  std::vector<PoseEstimate> last;
  while (!waiting_.empty()) last.push_back(solve_next());
  reset();
  return last;
}

void LiveReconstructor::reset() {
  frames_.clear();
  targets_.clear();
  graph_.reset();
  turning_.reset();
  waiting_.clear();
  num_recent_ = 0;
}

PoseEstimate LiveReconstructor::solve_next() {
  const Eigen::Index at = num_recent_ - static_cast<Eigen::Index>(waiting_.size());
  const retrieval::SignalWindow window{recent_, 0, num_recent_, at};
  solver_.search(window, neighbours_);
  graph_.extend(neighbours_);
  RetrievedFrame retrieved = solver_.retrieve(graph_.paths(), window, waiting_.front());
  const double time_s = waiting_.front().time_s;
  waiting_.pop_front();
  if (!targets_.empty())
    retrieved.target.agreement =
        evened_agreement(retrieved.target.agreement, targets_.back().agreement);
  if (frames_.size() > BandedSystem::kReach) {
    frames_.erase(frames_.begin());
    targets_.erase(targets_.begin());
  }
  FittedFrame start = start_of(skeleton(), 1.0 / rate_hz(), retrieved.target,
                               frames_.empty() ? nullptr : &frames_.back());
  if (!frames_.empty()) start.rotations = frames_.back().rotations;
  frames_.push_back(std::move(start));
  targets_.push_back(std::move(retrieved.target));
  fit_.fit(frames_, targets_, frames_.size() - 1, solver_.config().max_iterations);
  PoseEstimate estimate = to_estimate(frames_.back(), time_s, targets_.back().feet.certainty,
                                      std::move(retrieved.diagnostics));
  estimate.extremities = retrieved.extremities;
  return estimate;
}

}  // namespace sparse_mocap::path_regression
