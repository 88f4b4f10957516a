// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

// A leg or an arm in one pose, world frame.
struct TwoBoneLimb {
  Vec3 begin, middle, end;  // hip, knee, ankle
  Mat3 R_upper, R_lower;    // world rotations of the joints that turn the two bones
};

// Bends and turns the limb so that its end gets to the target, or as near as its length allows; the
// plane in which it bends turns as little as possible. aside: the axis about which it bends where
// it is straight. Bones keep their twist about the limb's plane.
void reach(const Vec3& target, const Vec3& aside, TwoBoneLimb& limb);

}  // namespace sparse_mocap
