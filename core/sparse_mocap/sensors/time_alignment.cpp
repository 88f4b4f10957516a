// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/time_alignment.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

constexpr double kGrid_hz = 200.0;
constexpr GaussianFilter kSmooth{0.008};

// Evenly sampled from begin_s on.
Eigen::VectorXd on_grid(std::span<const double> times_s, std::span<const double> values,
                        double begin_s, Eigen::Index count) {
  std::vector<double> grid;
  for (Eigen::Index i = 0; i < count; ++i)
    grid.push_back(begin_s + static_cast<double>(i) / kGrid_hz);
  const Eigen::MatrixXd row =
      Eigen::Map<const Eigen::RowVectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return filtered_at(times_s, row, grid, kSmooth).transpose();
}

double correlation(const Eigen::Ref<const Eigen::VectorXd>& a,
                   const Eigen::Ref<const Eigen::VectorXd>& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / std::max(x.norm() * y.norm(), 1e-9);
}

// How much a signal varies in each window, by running sums.
Eigen::VectorXd variations(const Eigen::VectorXd& values, Eigen::Index window) {
  Eigen::VectorXd out(values.size() - window + 1);
  double sum = values.head(window).sum(), squares = values.head(window).squaredNorm();
  const double n = static_cast<double>(window);
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = std::sqrt(std::max(squares / n - (sum / n) * (sum / n), 0.0));
    if (i + 1 == out.size()) break;
    sum += values[i + window] - values[i];
    squares += values[i + window] * values[i + window] - values[i] * values[i];
  }
  return out;
}

// The window of the first signal in which it varies most, and the second with it.
Eigen::Index common_event(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
                          Eigen::Index window, Eigen::Index largest_lag) {
  const Eigen::VectorXd a = variations(first, window), b = variations(second, window);
  Eigen::Index best = largest_lag;
  double most = -1.0;
  for (Eigen::Index i = largest_lag; i + largest_lag < a.size(); ++i) {
    const double both = a[i] * b.segment(i - largest_lag, 2 * largest_lag + 1).maxCoeff();
    if (both > most) most = both, best = i;
  }
  return best;
}

TimeLag peak(const Eigen::VectorXd& correlations, Eigen::Index largest_lag) {
  TimeLag out;
  Eigen::Index at = 0;
  out.correlation = correlations.maxCoeff(&at);
  double shift = 0.0;
  if (at > 0 && at + 1 < correlations.size()) {
    const double left = correlations[at - 1], right = correlations[at + 1];
    const double bend = left - 2.0 * out.correlation + right;
    if (bend < 0.0) shift = 0.5 * (left - right) / bend;
  }
  out.lag_s = (static_cast<double>(at - largest_lag) + shift) / kGrid_hz;
  // Another lag: beyond the valleys at both sides of the peak.
  Eigen::Index low = at, high = at;
  while (low > 0 && correlations[low - 1] < correlations[low]) --low;
  while (high + 1 < correlations.size() && correlations[high + 1] < correlations[high]) ++high;
  if (low > 0) out.runner_up = std::max(out.runner_up, correlations.head(low).maxCoeff());
  if (high + 1 < correlations.size())
    out.runner_up =
        std::max(out.runner_up, correlations.tail(correlations.size() - high - 1).maxCoeff());
  return out;
}

}  // namespace

TimeLag align_in_time(std::span<const double> first_times_s, std::span<const double> first,
                      std::span<const double> second_times_s, std::span<const double> second,
                      AlignmentSettings settings) {
  if (first.size() != first_times_s.size() || second.size() != second_times_s.size() ||
      first.empty() || second.empty())
    throw std::invalid_argument("align_in_time: one value for each time is needed");
  const double begin_s = std::max(first_times_s.front(), second_times_s.front());
  const double end_s = std::min(first_times_s.back(), second_times_s.back());
  const auto count = static_cast<Eigen::Index>((end_s - begin_s) * kGrid_hz) + 1;
  const auto window = static_cast<Eigen::Index>(settings.window_s * kGrid_hz);
  const auto largest_lag = static_cast<Eigen::Index>(settings.largest_lag_s * kGrid_hz);
  if (window < 3 || largest_lag < 1 || count < window + 2 * largest_lag + 1)
    throw std::invalid_argument(
        "the recordings overlap by too little; record the event well inside both");
  const Eigen::VectorXd a = on_grid(first_times_s, first, begin_s, count);
  const Eigen::VectorXd b = on_grid(second_times_s, second, begin_s, count);
  const Eigen::Index at = common_event(a, b, window, largest_lag);
  Eigen::VectorXd correlations(2 * largest_lag + 1);
  for (Eigen::Index lag = -largest_lag; lag <= largest_lag; ++lag)
    correlations[lag + largest_lag] =
        correlation(a.segment(at, window), b.segment(at + lag, window));
  TimeLag out = peak(correlations, largest_lag);
  out.event_s = begin_s + (static_cast<double>(at) + 0.5 * static_cast<double>(window)) / kGrid_hz;
  return out;
}

}  // namespace sparse_mocap
