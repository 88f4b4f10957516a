// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/sensor_headings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::path_regression {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostTrust = 2.0;  // of a hint

TrustedTurn turned_back(const TrustedTurn& turn, double by_rad) {
  return turn * std::polar(1.0, -by_rad);
}

double decay_of(const HeadingSettings& settings) {
  return std::exp(-1.0 / (settings.memory_s * settings.rate_hz));
}

// A sensor's sum of hints before the first one. A tracker seems to have been heard for long, with
// the heading that all share.
TrustedTurn first_sum(const HeadingSettings& settings, std::size_t sensor) {
  return settings.is_own[sensor] ? 0.0 : kMostTrust / (1.0 - decay_of(settings));
}

// The sum with the next hint, which counts most. With a heading of its own it begins anew after a
// silence.
TrustedTurn next_sum(const HeadingSettings& settings, std::size_t sensor, const TrustedTurn& sum,
                     const HeadingHint& hint, double common_rad) {
  if (settings.is_own[sensor] && !hint.is_heard) return 0.0;
  return decay_of(settings) * sum + turned_back(hint.turn, common_rad);
}

// What remains of an angle beyond a limit.
double beyond(double limit_rad, double angle_rad) {
  return std::copysign(std::max(std::abs(angle_rad) - limit_rad, 0.0), angle_rad);
}

void put_offsets(const HeadingSettings& settings, std::span<const HeadingHint> hints,
                 std::span<const TrustedTurn> sums, std::span<double> offsets_rad) {
  const double settled = kMostTrust * HeadingSettings::kSettled_s * settings.rate_hz;
  bool are_settled = true;
  for (std::size_t s = 0; s < sums.size(); ++s) {
    if (!settings.is_own[s]) {
      offsets_rad[s] = beyond(HeadingSettings::kStyle_rad, std::arg(sums[s]));
      continue;
    }
    offsets_rad[s] = hints[s].is_heard ? std::arg(sums[s]) : kUnknown;
    are_settled &= std::isnan(offsets_rad[s]) || std::abs(sums[s]) >= settled;
  }
  for (std::size_t s = 0; s < sums.size() && !are_settled; ++s)
    if (settings.is_own[s]) offsets_rad[s] = kUnknown;
}

}  // namespace

HeadingHint heading_hint(const Eigen::Vector4d& orientation, const Mat3& R_heading_sensor) {
  if (!orientation.allFinite()) return {};
  const Mat3 sum =
      R_heading_sensor * quaternion_of(orientation).normalized().toRotationMatrix().transpose();
  return {true, {sum(0, 0) + sum(2, 2), sum(0, 2) - sum(2, 0)}};
}

void put_heading_hints(const Reading& reading, std::span<const Mat3> R_heading_sensor,
                       std::vector<HeadingHint>& hints) {
  hints.clear();
  for (std::size_t s = 0; s < R_heading_sensor.size(); ++s)
    hints.push_back(
        heading_hint(reading.orientation.col(static_cast<Eigen::Index>(s)), R_heading_sensor[s]));
}

void put_no_hints(const Reading& reading, std::vector<HeadingHint>& hints) {
  hints.clear();
  for (Eigen::Index s = 0; s < reading.num_sensors(); ++s)
    hints.push_back({reading.orientation.col(s).allFinite(), 0.0});
}

void turn_headings(std::span<const double> offsets_rad, Reading& reading) {
  for (std::size_t s = 0; s < offsets_rad.size(); ++s) {
    auto orientation = reading.orientation.col(static_cast<Eigen::Index>(s));
    if (std::isnan(offsets_rad[s])) {
      orientation.setConstant(kUnknown);
    } else if (orientation.allFinite() && offsets_rad[s] != 0.0) {
      const Quat turned =
          Quat(yaw_rotation(offsets_rad[s])) * quaternion_of(Eigen::Vector4d(orientation));
      orientation << turned.w(), turned.x(), turned.y(), turned.z();
    }
  }
}

SensorHeadings::SensorHeadings(HeadingSettings settings) : settings_(std::move(settings)) {
  reset();
}

void SensorHeadings::reset() {
  sums_.clear();
  offsets_rad_.clear();
  for (std::size_t s = 0; s < settings_.is_own.size(); ++s) {
    sums_.push_back(first_sum(settings_, s));
    offsets_rad_.push_back(settings_.is_own[s] ? kUnknown : 0.0);
  }
}

// By those whose offsets are known; at first by the clearest hint, whose offset is 0 therefore.
double SensorHeadings::common_rad(std::span<const HeadingHint> hints) const {
  TrustedTurn common = 0.0, clearest = 0.0;
  for (std::size_t s = 0; s < hints.size(); ++s) {
    if (sums_[s] != 0.0) common += turned_back(hints[s].turn, std::arg(sums_[s]));
    if (std::abs(hints[s].turn) > std::abs(clearest)) clearest = hints[s].turn;
  }
  return std::arg(common != 0.0 ? common : clearest);
}

double SensorHeadings::observe(std::span<const HeadingHint> hints) {
  const double common = common_rad(hints);
  for (std::size_t s = 0; s < hints.size(); ++s)
    sums_[s] = next_sum(settings_, s, sums_[s], hints[s], common);
  put_offsets(settings_, hints, sums_, offsets_rad_);
  return common;
}

std::vector<std::vector<double>> whole_take_offsets(
    const HeadingSettings& settings, const std::vector<std::vector<HeadingHint>>& hints) {
  constexpr int kRounds = 8;  // offsets and headings in turns
  const std::size_t count = hints.size(), num_sensors = settings.is_own.size();
  std::vector<double> common_rad;
  SensorHeadings causal(settings);
  for (const auto& of_reading : hints) common_rad.push_back(causal.observe(of_reading));
  std::vector<std::vector<double>> offsets_rad(count, std::vector<double>(num_sensors));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<TrustedTurn>> sums(count, std::vector<TrustedTurn>(num_sensors));
    for (std::size_t s = 0; s < num_sensors; ++s) {
      TrustedTurn before = first_sum(settings, s), behind = 0.0;
      for (std::size_t t = 0; t < count; ++t)
        sums[t][s] += before = next_sum(settings, s, before, hints[t][s], common_rad[t]);
      for (std::size_t t = count; t-- > 0;)
        sums[t][s] += behind = next_sum(settings, s, behind, hints[t][s], common_rad[t]);
    }
    for (std::size_t t = 0; t < count; ++t) {
      put_offsets(settings, hints[t], sums[t], offsets_rad[t]);
      TrustedTurn common = 0.0;
      for (std::size_t s = 0; s < num_sensors; ++s)
        if (sums[t][s] != 0.0) common += turned_back(hints[t][s].turn, std::arg(sums[t][s]));
      common_rad[t] = std::arg(common);
    }
  }
  return offsets_rad;
}

}  // namespace sparse_mocap::path_regression
