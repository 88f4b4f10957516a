// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/heading_rate.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kAverage_s = 0.5;  // standard deviation; little of a cycle of a second is left

}  // namespace

double turning_rate(const Reading& reading) {
  return reading.gravity_direction.col(0).dot(reading.angular_velocity.col(0));
}

Eigen::VectorXd turned_as_measured(const Eigen::VectorXd& modelled, const Eigen::VectorXd& measured,
                                   double rate_hz) {
  const double sigma_frames = kAverage_s * rate_hz;
  const auto reach = static_cast<Eigen::Index>(std::ceil(3.0 * sigma_frames));
  Eigen::VectorXd out = modelled;
  for (Eigen::Index t = 0; t < modelled.size(); ++t) {
    double sum = 0.0, total = 0.0;
    const Eigen::Index end = std::min(t + reach + 1, modelled.size());
    for (Eigen::Index other = std::max<Eigen::Index>(t - reach, 0); other < end; ++other) {
      if (!std::isfinite(measured[other])) continue;
      const double distance = static_cast<double>(other - t) / sigma_frames;
      const double weight = std::exp(-0.5 * distance * distance);
      sum += weight * (measured[other] - modelled[other]);
      total += weight;
    }
    if (total > 0.0) out[t] += sum / total;
  }
  return out;
}

}  // namespace sparse_mocap::eom2014
