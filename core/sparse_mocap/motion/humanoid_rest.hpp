// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/motion/humanoid.hpp"
#include "sparse_mocap/motion/humanoid_posture.hpp"

namespace sparse_mocap {

// Fills carriers and bones (source's lengths times unit_scale).
void match_rest(const Skeleton& source, const RestPosture& rest, HumanoidMapping& mapping);

// The smallest rotation that turns one direction into another.
Mat3 smallest_rotation(const Vec3& from, const Vec3& to);

// The axis about which a standard hinge bends, in rest (elbow, knee: the lower limb's joint).
Vec3 hinge_axis(standard_joint::Index lower);

}  // namespace sparse_mocap
