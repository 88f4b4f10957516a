// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// The source's movement on a standard skeleton. World rotations are carried over joint by joint, so
// limbs point where the source's do; an upper limb twists where the source's elbow or knee leaves
// the plane of a hinge. Root translation is scaled by the ratio of leg lengths so that feet do not
// slide. A rest pose or T-pose that exporters put before the movement is dropped (it makes
// accelerations of thousands of m/s^2) and reported in warnings. Feet, toes and hands come along
// where the standard skeleton is one with extremities; those that the source lacks are relaxed.
Motion to_standard(const Motion& source, const SkeletonMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings = nullptr);

}  // namespace sparse_mocap
