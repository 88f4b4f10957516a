// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/method.hpp"

#include <iterator>
#include <string>
#include <utility>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

bool LiveMethod::step_into(const Reading& reading, PoseEstimate& estimate) {
  auto next = step(reading);
  if (next) estimate = std::move(*next);
  return next.has_value();
}

void require_sensors(const Reading& reading, Eigen::Index num_sensors) {
  if (reading.num_sensors() != num_sensors)
    throw ConfigError("a reading of " + std::to_string(num_sensors) + " sensors is expected, got " +
                      std::to_string(reading.num_sensors()));
}

std::vector<PoseEstimate> solve_live(LiveMethod& method, const std::vector<Reading>& take,
                                     const Progress& progress) {
  method.reset();
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < take.size(); ++t) {
    progress.report(t, take.size(), "reconstructing");
    if (auto estimate = method.step(take[t])) estimates.push_back(std::move(*estimate));
  }
  auto last = method.flush();
  std::move(last.begin(), last.end(), std::back_inserter(estimates));
  return estimates;
}

}  // namespace sparse_mocap
