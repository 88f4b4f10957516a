// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/resampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sparse_mocap {
namespace {

constexpr double kSlack_s = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Whether a time lies in a gap between samples. Before the first sample and after the last one a
// moment is no gap, unless the sensor is known to have left.
bool is_silent(const std::vector<double>& times_s, double at_s, bool has_ended) {
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), at_s - kSlack_s);
  if (after != times_s.end() && *after <= at_s + kSlack_s) return false;
  const double before_s = after == times_s.begin() ? -kInfinity : *(after - 1);
  const double after_s = after == times_s.end() ? kInfinity : *after;
  if (std::isinf(before_s) && std::isinf(after_s)) return true;
  if (std::isinf(after_s) && !has_ended) return true;
  const double gap_s = std::isinf(before_s)  ? after_s - at_s
                       : std::isinf(after_s) ? at_s - before_s
                                             : after_s - before_s;
  return gap_s > Resampler::kLongestGap_s + kSlack_s;
}

}  // namespace

Resampler::Resampler(int num_sensors, double rate_hz, GaussianFilter filter)
    : rate_hz_(rate_hz), filter_(filter) {
  if (num_sensors < 1 || !(rate_hz > 0.0))
    throw std::invalid_argument("Resampler: sensors and a positive rate are needed");
  heard_.resize(static_cast<std::size_t>(num_sensors));
}

bool Resampler::push(int sensor, double time_s, const Vec3& specific_force) {
  Heard& heard = heard_.at(static_cast<std::size_t>(sensor));
  if (!std::isfinite(time_s) || !specific_force.allFinite()) return false;
  if (!heard.times_s.empty() && time_s <= heard.times_s.back()) return false;
  if (num_given_ == 0) begin_s_ = std::min(begin_s_.value_or(time_s), time_s);
  heard.times_s.push_back(time_s);
  heard.values.push_back(specific_force);
  return true;
}

bool Resampler::is_ready(double time_s, double now_s) const {
  if (now_s >= time_s + filter_.reach_s() + kLongestGap_s) return true;
  return std::all_of(heard_.begin(), heard_.end(), [&](const Heard& heard) {
    return !heard.times_s.empty() && heard.times_s.back() >= time_s + filter_.reach_s();
  });
}

ResampledFrame Resampler::frame_at(double time_s, bool has_ended) const {
  ResampledFrame frame;
  frame.time_s = time_s;
  frame.specific_force.resize(3, static_cast<Eigen::Index>(heard_.size()));
  for (std::size_t s = 0; s < heard_.size(); ++s) {
    const auto& [times, values] = heard_[s];
    auto column = frame.specific_force.col(static_cast<Eigen::Index>(s));
    if (is_silent(times, time_s, has_ended)) {
      column.setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    Eigen::MatrixXd matrix(3, static_cast<Eigen::Index>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
      matrix.col(static_cast<Eigen::Index>(i)) = values[i];
    column = filtered_at(times, matrix, std::vector<double>{time_s}, filter_);
  }
  return frame;
}

// Keeps what the kernel of later frames can reach, and the last sample before it.
void Resampler::forget(double before_s) {
  for (Heard& heard : heard_) {
    const auto first = std::lower_bound(heard.times_s.begin(), heard.times_s.end(), before_s);
    const auto spare = std::max<std::ptrdiff_t>(first - heard.times_s.begin() - 1, 0);
    heard.times_s.erase(heard.times_s.begin(), heard.times_s.begin() + spare);
    heard.values.erase(heard.values.begin(), heard.values.begin() + spare);
  }
}

std::vector<ResampledFrame> Resampler::frames_until(double now_s) {
  std::vector<ResampledFrame> frames;
  while (begin_s_ && is_ready(next_time_s(), now_s)) {
    frames.push_back(frame_at(next_time_s(), false));
    ++num_given_;
    forget(next_time_s() - filter_.reach_s());
  }
  return frames;
}

std::vector<ResampledFrame> Resampler::flush() {
  std::vector<ResampledFrame> frames;
  double end_s = -kInfinity;
  for (const Heard& heard : heard_)
    if (!heard.times_s.empty()) end_s = std::max(end_s, heard.times_s.back());
  while (begin_s_ && next_time_s() <= end_s + kSlack_s) {
    frames.push_back(frame_at(next_time_s(), true));
    ++num_given_;
  }
  return frames;
}

}  // namespace sparse_mocap
