// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/live.hpp"

#include <algorithm>
#include <utility>

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
  PoseEstimate estimate;
  if (!step_into(measured, estimate)) return std::nullopt;
  return estimate;
}

bool LiveReconstructor::step_into(const Reading& measured, PoseEstimate& estimate) {
  require_sensors(measured, solver_.num_sensors());
  const Reading& reading = turning_(measured);
  if (num_recent_ == recent_.rows()) {
    std::copy(recent_.data() + recent_.cols(), recent_.data() + recent_.size(), recent_.data());
    --num_recent_;
  }
  retrieval::put_signals(reading, solver_.signals(), recent_.row(num_recent_++));
  if (num_waiting_ == waiting_.size()) waiting_.emplace_back();
  waiting_[num_waiting_++] = reading;
  if (static_cast<int>(num_waiting_) <= solver_.look_ahead()) return false;
  solve_next(estimate);
  return true;
}

std::vector<PoseEstimate> LiveReconstructor::flush() {
  std::vector<PoseEstimate> last;
  while (num_waiting_ > 0) solve_next(last.emplace_back());
  reset();
  return last;
}

void LiveReconstructor::reset() {
  frames_.clear();
  targets_.clear();
  graph_.reset();
  turning_.reset();
  num_waiting_ = 0;
  num_recent_ = 0;
}

void LiveReconstructor::solve_next(PoseEstimate& estimate) {
  const Eigen::Index at = num_recent_ - static_cast<Eigen::Index>(num_waiting_);
  const retrieval::SignalWindow window{recent_, 0, num_recent_, at};
  solver_.search(window, neighbours_);
  graph_.extend(neighbours_);
  solver_.retrieve(graph_.paths(), window, waiting_.front(), retrieved_);
  const double time_s = waiting_.front().time_s;
  std::rotate(waiting_.begin(), waiting_.begin() + 1, waiting_.end());
  --num_waiting_;
  if (!targets_.empty())
    retrieved_.target.agreement =
        evened_agreement(retrieved_.target.agreement, targets_.back().agreement);
  add_frame();
  fit_.fit(frames_, targets_, frames_.size() - 1, solver_.config().max_iterations);
  put_estimate(frames_.back(), time_s, targets_.back().feet.certainty, estimate);
  estimate.diagnostics.swap(retrieved_.diagnostics);
  estimate.extremities = retrieved_.extremities;
}

// The retrieved frame after the others, its pose that of the last one; the oldest one makes place.
void LiveReconstructor::add_frame() {
  if (frames_.empty()) {
    frames_.push_back(start_of(skeleton(), 1.0 / rate_hz(), retrieved_.target, nullptr));
    targets_.push_back(retrieved_.target);
    return;
  }
  if (frames_.size() > BandedSystem::kReach) {
    std::rotate(frames_.begin(), frames_.begin() + 1, frames_.end());
    std::rotate(targets_.begin(), targets_.begin() + 1, targets_.end());
  } else {
    frames_.emplace_back();
    targets_.emplace_back();
  }
  frames_.back() = frames_[frames_.size() - 2];
  move_root(1.0 / rate_hz(), retrieved_.target, frames_.back());
  std::swap(targets_.back(), retrieved_.target);
}

}  // namespace sparse_mocap::path_regression
