// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/resampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sparse_mocap/base/quaternions.hpp"

namespace sparse_mocap {
namespace {

constexpr double kSlack_s = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_silent(std::span<const double> times_s, double at_s, bool has_ended) {
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

bool Resampler::push(double time_s, std::span<const double> value) {
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::isfinite(time_s) || !std::all_of(value.begin(), value.end(), is_finite)) return false;
  if (!times_s_.empty() && time_s <= times_s_.back()) return false;
  times_s_.push_back(time_s);
  values_.insert(values_.end(), value.begin(), value.end());
  return true;
}

bool Resampler::reaches(double time_s) const {
  return !times_s_.empty() && times_s_.back() >= time_s;
}

Eigen::VectorXd Resampler::at(double time_s, GaussianFilter filter, bool has_ended) const {
  if (is_silent(times_s(), time_s, has_ended))
    return Eigen::VectorXd::Constant(rows(), std::numeric_limits<double>::quiet_NaN());
  if (kind_ == Kind::rotation) return rotation_at(time_s);
  return filtered_at(times_s(), values(), std::span(&time_s, 1), filter);
}

void Resampler::forget(double before_s) {
  const auto times = times_s();
  const auto first = std::lower_bound(times.begin(), times.end(), before_s) - times.begin();
  begin_ += static_cast<std::size_t>(std::max<std::ptrdiff_t>(first - 1, 0));
  if (2 * begin_ <= times_s_.size()) return;
  const auto gone = static_cast<std::ptrdiff_t>(begin_);
  times_s_.erase(times_s_.begin(), times_s_.begin() + gone);
  values_.erase(values_.begin(), values_.begin() + gone * rows());
  begin_ = 0;
}

std::span<const double> Resampler::times_s() const { return std::span(times_s_).subspan(begin_); }

Eigen::Map<const Eigen::MatrixXd> Resampler::values() const {
  const auto skipped = static_cast<Eigen::Index>(begin_);
  return {values_.data() + skipped * rows(), rows(),
          static_cast<Eigen::Index>(times_s_.size()) - skipped};
}

Eigen::VectorXd Resampler::rotation_at(double time_s) const {
  const auto times = times_s();
  const auto all = values();
  const auto after = std::upper_bound(times.begin(), times.end(), time_s) - times.begin();
  if (after == 0) return all.col(0).normalized();
  if (after == all.cols()) return all.col(after - 1).normalized();
  const double before_s = times[static_cast<std::size_t>(after - 1)];
  const double after_s = times[static_cast<std::size_t>(after)];
  const Quat from = quaternion_of(all.col(after - 1)).normalized();
  const Quat to = quaternion_of(all.col(after)).normalized();
  return wxyz_of(from.slerp((time_s - before_s) / (after_s - before_s), to));
}

}  // namespace sparse_mocap
