// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/retargeting/foot_stands.hpp"
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

struct FootLockOptions {
  double strength = 1.0;        // 0 (feet as they come) to 1 (feet stay where they stand)
  double ankle_height_m = 0.1;  // of a foot flat on the floor, which is at y = 0
  StandOptions stands;
};

struct LockedFeet {
  Motion motion;
  std::array<std::vector<Stand>, 2> stands;  // left, right
};

// A rig's motion with feet that stay where they stand and do not sink into the floor: legs are bent
// to where the ankles have to be, the pelvis is lowered where a leg would be too short, standing
// feet lie flat, and toes are lifted out of the floor. contacts: 2 x T, how certain it is that the
// left and the right foot stand, 0 to 1. A rig without feet is returned as it is. Throws
// std::invalid_argument for another number of frames or joints.
LockedFeet lock_feet(const Motion& rig_motion, const SkeletonMapping& mapping,
                     const Eigen::Matrix2Xd& contacts, const FootLockOptions& options);

}  // namespace sparse_mocap
