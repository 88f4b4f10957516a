// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/retargeting/bone_positions.hpp"
#include "sparse_mocap/retargeting/joint_mapping.hpp"

namespace sparse_mocap {

// The rig's joint of each extremity; joint -1: there is none.
using ExtremityMapping = std::array<MappedJoint, kNumExtremities>;

// Finds feet, toes and hands beyond the ankles and wrists that are known, and aligns them in rest:
// there feet are taken to be level, whatever their bones' slope, and hands to lie as the wrists do
// (R_world_wrist of the standard skeleton in that pose: left, right).
ExtremityMapping map_extremities(const Skeleton& rig, const BodyJoints& joints,
                                 const BonePositions& bones, const JointTransforms& rest,
                                 const std::array<Mat3, 2>& R_world_wrist);

}  // namespace sparse_mocap
