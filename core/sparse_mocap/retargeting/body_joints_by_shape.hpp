// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/retargeting/joint_names.hpp"

namespace sparse_mocap {

// Joints of the parts of a body: [part][left, right, middle], -1 where unknown.
using PartJoints = std::array<std::array<int, 3>, kNumBodyParts>;

int& joint_of(PartJoints& parts, BodyPart part, Side side);

// Finds limbs and head by the tree's shape and where things are: arms and legs are the two pairs of
// long chains that mirror each other, the legs being the longer ones. Fills what is unknown.
void find_parts_by_shape(const Skeleton& rig, const JointTransforms& pose, PartJoints& parts);

}  // namespace sparse_mocap
