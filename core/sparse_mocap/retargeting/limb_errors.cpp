// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/limb_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sparse_mocap/retargeting/source_motion.hpp"

namespace sparse_mocap {

double LimbErrors::overall_mean_rad() const {
  return std::accumulate(mean_rad.begin(), mean_rad.end(), 0.0) /
         static_cast<double>(mean_rad.size());
}

double LimbErrors::overall_worst_rad() const {
  return *std::max_element(worst_rad.begin(), worst_rad.end());
}

LimbErrors limb_errors(const Motion& file, const SkeletonMapping& mapping, const Motion& mapped) {
  const Motion source = without_collapsed_offsets(file);
  const int lead = source.num_frames() - mapped.num_frames();
  LimbErrors errors;
  for (int t = 0; t < mapped.num_frames(); ++t) {
    const auto bones = bone_positions(source.skeleton, mapping.joints, source.transforms(t + lead));
    const auto standard = mapped.transforms(t);
    for (std::size_t i = 0; i < kLimbBones.size(); ++i) {
      const auto bone = kLimbBones[i];
      const Vec3 wanted = mapping.R_world_file * bones.vector(bone);
      const double error = angle_between(wanted, standard.end[bone] - standard.pivot[bone]);
      errors.mean_rad[i] += error / mapped.num_frames();
      errors.worst_rad[i] = std::max(errors.worst_rad[i], error);
    }
  }
  return errors;
}

}  // namespace sparse_mocap
