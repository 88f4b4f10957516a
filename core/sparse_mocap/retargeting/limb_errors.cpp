// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/limb_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sparse_mocap/retargeting/rest_pose.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"

namespace sparse_mocap {

double LimbErrors::overall_mean_rad() const {
  return std::accumulate(mean_rad.begin(), mean_rad.end(), 0.0) /
         static_cast<double>(mean_rad.size());
}

double LimbErrors::overall_worst_rad() const {
  return *std::max_element(worst_rad.begin(), worst_rad.end());
}

namespace {

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// Where the source's own limb bone ends: at the first joint below it that is most of the mapped way
// down. So an ankle that the mapping passes over, or a bone that ends at the toes, is seen.
Vec3 own_limb(const Skeleton& rig, const SkeletonMapping& mapping, int bone,
              const JointTransforms& pose, const Vec3& mapped) {
  constexpr double kMostOfTheWay = 0.6;
  const int first = mapping.joints.standard[at(bone)];
  int last = -1;
  if (bone == standard_joint::ltibia) last = mapping.joints.ankle[0];
  if (bone == standard_joint::rtibia) last = mapping.joints.ankle[1];
  for (const auto& [upper, lower] : kHingedLimbs)
    if (bone == upper) last = mapping.joints.standard[lower];
  if (bone == standard_joint::lradius) last = mapping.joints.standard[standard_joint::lwrist];
  if (bone == standard_joint::rradius) last = mapping.joints.standard[standard_joint::rwrist];
  if (last < 0) return mapped;
  for (const int joint : path_down(rig, first, last)) {
    const Vec3 own = pose.pivot[at(joint)] - pose.pivot[at(first)];
    if (own.norm() > kMostOfTheWay * mapped.norm()) return own;
  }
  return mapped;
}

}  // namespace

LimbErrors limb_errors(const Motion& file, const SkeletonMapping& mapping, const Motion& mapped,
                       int step) {
  const Motion source = without_collapsed_offsets(file);
  const int lead = source.num_frames() - mapped.num_frames();
  LimbErrors errors;
  const int num_compared = (mapped.num_frames() + step - 1) / step;
  for (int t = 0; t < mapped.num_frames(); t += step) {
    const auto pose = source.transforms(t + lead);
    const auto bones = bone_positions(source.skeleton, mapping.joints, pose);
    const auto standard = mapped.transforms(t);
    for (std::size_t i = 0; i < kLimbBones.size(); ++i) {
      const auto bone = kLimbBones[i];
      const Vec3 wanted =
          mapping.R_world_file * own_limb(source.skeleton, mapping, bone, pose, bones.vector(bone));
      const double error = angle_between(wanted, standard.end[bone] - standard.pivot[bone]);
      errors.mean_rad[i] += error / num_compared;
      errors.worst_rad[i] = std::max(errors.worst_rad[i], error);
    }
  }
  return errors;
}

}  // namespace sparse_mocap
