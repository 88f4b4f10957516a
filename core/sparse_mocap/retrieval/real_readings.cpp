// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/real_readings.hpp"

#include <algorithm>
#include <string>

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::retrieval {

std::vector<float> distance_factors(const MotionDatabase& database, std::span<const Signal> signals,
                                    double preference) {
  std::vector<float> factors;
  bool is_any_real = false;
  for (const Clip& clip : database.clips()) {
    const auto num_real = std::count_if(signals.begin(), signals.end(), [&](const Signal& signal) {
      const auto& site = all_sites()[static_cast<std::size_t>(signal.site)];
      return is_real(clip, std::string(site.name), signal.channel);
    });
    const double share = static_cast<double>(num_real) /
                         static_cast<double>(std::max<std::size_t>(signals.size(), 1));
    factors.push_back(static_cast<float>(1.0 - preference * share));
    is_any_real |= num_real > 0;
  }
  if (!is_any_real || preference == 0.0) factors.clear();
  return factors;
}

void scale_distances(const MotionDatabase& database, std::span<const float> factors,
                     std::span<Neighbour> neighbours) {
  for (Neighbour& neighbour : neighbours)
    neighbour.distance *= factors[static_cast<std::size_t>(database.clip_index(neighbour.row))];
  std::sort(neighbours.begin(), neighbours.end());
}

}  // namespace sparse_mocap::retrieval
