// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/filter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sparse_mocap {
namespace {

Eigen::VectorXd interpolated(std::span<const double> times_s,
                             const Eigen::Ref<const Eigen::MatrixXd>& values, double at_s) {
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), at_s);
  if (after == times_s.begin()) return values.col(0);
  if (after == times_s.end()) return values.col(values.cols() - 1);
  const auto i = after - times_s.begin();
  const double t0 = times_s[static_cast<std::size_t>(i - 1)];
  const double fraction = (at_s - t0) / (*after - t0);
  return (1.0 - fraction) * values.col(i - 1) + fraction * values.col(i);
}

}  // namespace

Eigen::MatrixXd filtered_at(std::span<const double> times_s,
                            const Eigen::Ref<const Eigen::MatrixXd>& values,
                            std::span<const double> wanted_s, GaussianFilter filter) {
  if (times_s.empty() || static_cast<Eigen::Index>(times_s.size()) != values.cols())
    throw std::invalid_argument("filtered_at: one column of values for each time is needed");
  Eigen::MatrixXd out(values.rows(), static_cast<Eigen::Index>(wanted_s.size()));
  for (std::size_t k = 0; k < wanted_s.size(); ++k) {
    const double at_s = wanted_s[k];
    const auto begin = std::lower_bound(times_s.begin(), times_s.end(), at_s - filter.reach_s());
    const auto end = std::upper_bound(begin, times_s.end(), at_s + filter.reach_s());
    const auto column = static_cast<Eigen::Index>(k);
    if (end - begin < 2) {
      out.col(column) = interpolated(times_s, values, at_s);
      continue;
    }
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(values.rows());
    double total = 0.0;
    for (auto it = begin; it != end; ++it) {
      const double z = (*it - at_s) / filter.sigma_s;
      const double weight = std::exp(-0.5 * z * z);
      sum += weight * values.col(it - times_s.begin());
      total += weight;
    }
    out.col(column) = sum / total;
  }
  return out;
}

}  // namespace sparse_mocap
