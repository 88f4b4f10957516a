// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// A standard skeleton's movement on a rig: the reverse of to_standard, by the same mapping. World
// rotations are carried over joint by joint, so limbs point where the standard's do. A joint along
// which several standard bones lie takes their mean, weighted by length; joints along one standard
// bone all turn with it, so a spine of many joints bends where the standard's does. Joints that map
// to nothing keep their rest; feet, toes and hands do where the motion has none. Root translation
// is scaled by the ratio of leg lengths, in the rig's own unit and world; where the rig's root is
// not its pelvis, the root moves so that the pelvis gets there. mapping must be of this rig. Throws
// std::invalid_argument when it has another number of joints, or the motion is not on a standard
// skeleton.
Motion to_rig(const Motion& standard_motion, const SkeletonMapping& mapping, const Skeleton& rig);

// The rig's joints that to_rig turns, ascending.
std::vector<int> turned_joints(const SkeletonMapping& mapping);

}  // namespace sparse_mocap