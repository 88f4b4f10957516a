// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/live.hpp"

#include <algorithm>
#include <utility>

#include "sparse_mocap/path_regression/banded_system.hpp"

namespace sparse_mocap::path_regression {

LiveReconstructor::LiveReconstructor(const Config& config, const MethodContext& context)
    : solver_(config, context),
      turning_(context.sensors, config.use_own_headings),
      headings_(solver_.headings()),
      fit_(solver_.database().skeleton(), solver_.database().frame_time_s(), config.fit),
      graph_(retrieval::clips_of_frames(solver_.database()),
             {solver_.config().penalty, solver_.config().forgetting}),
      recent_(solver_.reach_back() + solver_.look_ahead() + 2,
              static_cast<Eigen::Index>(3 * solver_.signals().size())),
      num_held_(static_cast<std::size_t>(solver_.config().held_frames(rate_hz()))) {}

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
  put_signals_of(reading);
  if (num_waiting_ == waiting_.size()) waiting_.emplace_back();
  waiting_[num_waiting_++] = reading;
  if (static_cast<int>(num_waiting_) <= solver_.look_ahead()) return false;
  solve_next();
  if (fitted_.size() <= num_held_) return false;
  put_fitted(fitted_.size() - 1 - num_held_, estimate);
  return true;
}

// With headings as far as they are known by now.
void LiveReconstructor::put_signals_of(const Reading& reading) {
  if (solver_.has_headings()) {
    turned_ = reading;
    turn_headings(headings_.offsets_rad(), turned_);
  }
  retrieval::put_signals(solver_.has_headings() ? turned_ : reading, solver_.signals(),
                         recent_.row(num_recent_++));
}

std::vector<PoseEstimate> LiveReconstructor::flush() {
  std::vector<PoseEstimate> last;
  while (num_waiting_ > 0) {
    solve_next();
    if (fitted_.size() > num_held_) put_fitted(fitted_.size() - 1 - num_held_, last.emplace_back());
  }
  for (std::size_t held = std::min(num_held_, fitted_.size()); held > 0; --held)
    put_fitted(fitted_.size() - held, last.emplace_back());
  reset();
  return last;
}

void LiveReconstructor::reset() {
  frames_.clear();
  targets_.clear();
  fitted_.clear();
  graph_.reset();
  turning_.reset();
  headings_.reset();
  num_waiting_ = 0;
  num_recent_ = 0;
}

// The pose that follows the last one, and those held back anew.
void LiveReconstructor::solve_next() {
  const Eigen::Index at = num_recent_ - static_cast<Eigen::Index>(num_waiting_);
  const retrieval::SignalWindow window{recent_, 0, num_recent_, at};
  solver_.search(window, neighbours_);
  graph_.extend(neighbours_);
  solver_.retrieve(graph_.paths(), window, waiting_.front(), retrieved_);
  if (solver_.has_headings()) {
    put_heading_hints(waiting_.front(), retrieved_.posed_sensors, heading_hints_);
    headings_.observe(heading_hints_);
  }
  if (!targets_.empty())
    retrieved_.target.agreement =
        evened_agreement(retrieved_.target.agreement, targets_.back().agreement);
  add_frame();
  const std::size_t num_free = std::min(num_held_ + 1, frames_.size());
  fit_.fit(frames_, targets_, frames_.size() - num_free, solver_.config().max_iterations);
  std::rotate(waiting_.begin(), waiting_.begin() + 1, waiting_.end());
  --num_waiting_;
}

// The retrieved frame after the others, its pose that of the last one; the oldest one makes place.
void LiveReconstructor::add_frame() {
  const bool is_first = frames_.empty();
  if (frames_.size() > BandedSystem::kReach + num_held_) {
    std::rotate(frames_.begin(), frames_.begin() + 1, frames_.end());
    std::rotate(targets_.begin(), targets_.begin() + 1, targets_.end());
    std::rotate(fitted_.begin(), fitted_.begin() + 1, fitted_.end());
  } else {
    frames_.emplace_back();
    targets_.emplace_back();
    fitted_.emplace_back();
  }
  if (is_first) {
    frames_.back() = start_of(skeleton(), 1.0 / rate_hz(), retrieved_.target, nullptr);
  } else {
    frames_.back() = frames_[frames_.size() - 2];
    move_root(1.0 / rate_hz(), retrieved_.target, frames_.back());
  }
  std::swap(targets_.back(), retrieved_.target);
  fitted_.back().time_s = waiting_.front().time_s;
  fitted_.back().diagnostics.swap(retrieved_.diagnostics);
  fitted_.back().extremities = retrieved_.extremities;
}

void LiveReconstructor::put_fitted(std::size_t at, PoseEstimate& estimate) {
  put_estimate(frames_[at], fitted_[at].time_s, targets_[at].feet.certainty, estimate);
  estimate.diagnostics.swap(fitted_[at].diagnostics);
  estimate.extremities = fitted_[at].extremities;
}

}  // namespace sparse_mocap::path_regression
