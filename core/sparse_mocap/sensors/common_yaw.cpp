// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/common_yaw.hpp"

#include <cmath>

namespace sparse_mocap {

double common_yaw_rad(std::span<const Mat3> measured, std::span<const Mat3> modelled) {
  // sum a.(R_y b) = cosine * cos(yaw) + sine * sin(yaw)
  double cosine = 0.0, sine = 0.0;
  for (std::size_t s = 0; s < measured.size(); ++s) {
    if (!measured[s].allFinite()) continue;
    const Mat3 sum = measured[s] * modelled[s].transpose();
    cosine += sum(0, 0) + sum(2, 2);
    sine += sum(0, 2) - sum(2, 0);
  }
  return std::atan2(sine, cosine);
}

}  // namespace sparse_mocap
