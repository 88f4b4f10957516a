// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/live.hpp"

namespace sparse_mocap::path_regression {

LiveReconstructor::LiveReconstructor(const Config& config, const MethodContext& context)
    : solver_(config, context),
      graph_(retrieval::clips_of_frames(solver_.database()),
             {solver_.config().penalty, solver_.config().forgetting}),
      recent_(solver_.reach_back() + solver_.look_ahead() + 2,
              static_cast<Eigen::Index>(3 * solver_.signals().size())) {}

std::optional<PoseEstimate> LiveReconstructor::step(const Reading& reading) {
  require_sensors(reading, solver_.num_sensors());
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
  solver_.reset();
  graph_.reset();
  waiting_.clear();
  num_recent_ = 0;
}

PoseEstimate LiveReconstructor::solve_next() {
  const Eigen::Index at = num_recent_ - static_cast<Eigen::Index>(waiting_.size());
  const retrieval::SignalWindow window{recent_, 0, num_recent_, at};
  solver_.search(window, neighbours_);
  graph_.extend(neighbours_);
  SolvedFrame frame = solver_.solve(graph_.paths(), window, waiting_.front());
  waiting_.pop_front();
  return to_estimate(std::move(frame), skeleton());
}

}  // namespace sparse_mocap::path_regression
