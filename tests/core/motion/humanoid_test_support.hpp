// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sparse_mocap/motion/humanoid.hpp"
#include "sparse_mocap/motion/humanoid_points.hpp"
#include "sparse_mocap/motion/humanoid_units.hpp"

namespace sparse_mocap::testing {

inline double angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kRadiansPerDegree;
}

struct DirectionErrors {
  double mean_deg = 0.0, worst_deg = 0.0;
};

// Angles between limbs (thighs, shanks, upper arms, forearms, spine and neck as a whole) of the
// source and of its movement on the standard skeleton.
inline DirectionErrors direction_errors(const Motion& file, const HumanoidMapping& mapping,
                                        const Motion& mapped) {
  using namespace standard_joint;
  constexpr std::array kLimbs{std::array{lfemur, lfemur},     std::array{rfemur, rfemur},
                              std::array{ltibia, ltibia},     std::array{rtibia, rtibia},
                              std::array{lhumerus, lhumerus}, std::array{rhumerus, rhumerus},
                              std::array{lradius, lradius},   std::array{rradius, rradius},
                              std::array{lowerback, thorax},  std::array{lowerneck, head}};
  const Motion source = with_sound_offsets(file);
  const int lead = source.num_frames() - mapped.num_frames();
  DirectionErrors errors;
  int count = 0;
  for (int t = 0; t < mapped.num_frames(); ++t) {
    const auto points =
        standard_points(source.skeleton, mapping.source, source.transforms(t + lead));
    const auto at = mapped.transforms(t);
    for (const auto& [first, last] : kLimbs) {
      // A head without a tip has no direction of its own: the neck alone tells.
      const Index end = last == head && !mapping.source.has_head_tip ? upperneck : last;
      const Vec3 wanted = mapping.R_world_file * (points.end[end] - points.begin[first]);
      if (wanted.norm() * mapping.unit_scale < 0.02) continue;
      const double error = angle_deg(wanted, at.end[end] - at.pivot[first]);
      errors.mean_deg += error;
      errors.worst_deg = std::max(errors.worst_deg, error);
      ++count;
    }
  }
  if (count > 0) errors.mean_deg /= count;
  return errors;
}

}  // namespace sparse_mocap::testing
