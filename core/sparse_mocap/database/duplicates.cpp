// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/duplicates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sparse_mocap/database/motion_database.hpp"

namespace sparse_mocap {
namespace {

using Rows = DatabaseRows::Rows;

constexpr int kLongestShift = 3;           // rows
constexpr double kHopeless_m = 0.1;        // apart before the shift by a part of a row
constexpr double kVelocityWeight_s = 0.2;  // a wrong speed counts like being so long under way

// Joint positions, and root motion as lengths: clips that are alike but walk elsewhere differ.
Rows features_of(const DatabaseRows& rows) {
  using namespace root_motion_column;
  const Eigen::Index joints = rows.positions.cols();
  Rows features(rows.positions.rows(), joints + count);
  features << rows.positions, rows.root_motion;
  for (const int column : {velocity_left, velocity_forward, yaw_rate})
    features.col(joints + column) *= static_cast<float>(kVelocityWeight_s);
  return features;
}

// The distance of a(t) and b(t + lag), with the part of a row more or less that fits best:
// to first order a shift by s rows changes a by s times its rate of change.
std::optional<ClipDistance> distance_at(const Rows& a, const Rows& b, int lag) {
  const Eigen::Index begin = std::max<Eigen::Index>(1, 1 - lag);
  const Eigen::Index end = std::min(a.rows(), b.rows() - lag) - 1;
  if (end <= begin) return std::nullopt;
  const Eigen::Index columns = a.cols() - root_motion_column::count;
  const double num_joints = static_cast<double>(columns) / 3.0;
  const double frames = static_cast<double>(end - begin);
  const double hopeless = kHopeless_m * kHopeless_m * num_joints * frames;
  double squares = 0.0, products = 0.0, squared_rates = 0.0, squared_steps = 0.0;
  for (Eigen::Index t = begin; t < end; ++t) {
    const auto difference = b.row(t + lag) - a.row(t);
    const auto rate = 0.5F * (a.row(t + 1) - a.row(t - 1));
    squares += static_cast<double>(difference.squaredNorm());
    if (squares > hopeless) return std::nullopt;
    products += static_cast<double>(difference.dot(rate));
    squared_rates += static_cast<double>(rate.squaredNorm());
    squared_steps += static_cast<double>(rate.head(columns).squaredNorm());
  }
  const double shift = squared_rates > 0.0 ? std::clamp(products / squared_rates, -1.0, 1.0) : 0.0;
  const double left = squares - 2.0 * shift * products + shift * shift * squared_rates;
  const auto rms = [&](double sum) {
    return std::sqrt(std::max(0.0, sum) / (num_joints * frames));
  };
  return ClipDistance{rms(left), rms(squared_steps)};
}

// Shorter clips must lie closer together, or little would be left to compare.
int longest_shift(Eigen::Index length) {
  return std::min(kLongestShift, static_cast<int>(length / 8));
}

std::optional<ClipDistance> distance(const Rows& a, const Rows& b) {
  const int longest = longest_shift(std::min(a.rows(), b.rows()));
  if (std::abs(a.rows() - b.rows()) > longest) return std::nullopt;
  std::optional<ClipDistance> least;
  for (int lag = -longest; lag <= longest; ++lag)
    if (const auto found = distance_at(a, b, lag);
        found && (!least || found->apart_m < least->apart_m))
      least = found;
  return least;
}

}  // namespace

std::optional<ClipDistance> clip_distance(const DatabaseRows& a, const DatabaseRows& b) {
  return distance(features_of(a), features_of(b));
}

std::optional<int> DuplicateFinder::find(const DatabaseRows& rows) const {
  const Rows features = features_of(rows);
  std::optional<int> first;
  const auto end = by_length_.upper_bound(rows.num_frames() + kLongestShift);
  for (auto at = by_length_.lower_bound(rows.num_frames() - kLongestShift); at != end; ++at) {
    if (first && *first < at->second.id) continue;
    const auto found = distance(at->second.features, features);
    if (found && found->is_same_motion()) first = at->second.id;
  }
  return first;
}

void DuplicateFinder::add(int id, const DatabaseRows& rows) {
  by_length_.emplace(rows.num_frames(), Known{id, features_of(rows)});
}

}  // namespace sparse_mocap
