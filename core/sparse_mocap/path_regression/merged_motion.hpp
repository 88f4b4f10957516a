// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/path_regression/take_fit.hpp"

namespace sparse_mocap::path_regression {

// How the root moves from one frame to the next: in the heading frame of the first, m, and about
// the vertical.
struct RootStep {
  Vec3 step_m = Vec3::Zero();
  double turn_rad = 0.0;
};

RootStep root_step(const FittedFrame& before, const FittedFrame& frame);

// The frame, its root where this step leads from another one; its height stays.
FittedFrame after(const FittedFrame& before, const RootStep& root, FittedFrame frame);

// Each joint turned from one pose towards another: a where share is 0, b where it is 1.
JointRotations between(const JointRotations& a, const JointRotations& b, double share);

// What another motion has in place of a frame, how it came there, and how much it counts.
struct OtherFrame {
  FittedFrame frame;
  RootStep root;
  double share = 0.0;  // 0: not at all, 1: wholly
};

// The first motion with the other frames in it. Where they count nothing it has its own poses, and
// goes on from where it has come to.
std::vector<FittedFrame> merged(const std::vector<FittedFrame>& first,
                                const std::vector<OtherFrame>& others);

}  // namespace sparse_mocap::path_regression
