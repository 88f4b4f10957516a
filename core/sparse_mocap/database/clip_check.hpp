// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// What makes a clip doubtful, so that it does not get into a database unseen.
struct ClipFault {
  std::string text;       // what is wrong, by how much, and what to do
  double severity = 0.0;  // 1 at the limit; the worst of several clips is shown first
  bool is_refused = false;
};

// The limits. What is beyond a refusing limit is no person's movement; the others are rare in good
// recordings, but occur.
struct ClipLimits {
  double strayed_deg = 20.0;          // a limb's mean angle to the source's
  double refused_strayed_deg = 60.0;  // refuses
  double upright = 0.5;               // cosine of trunk and up, below which a body lies
  double falling_g = 2.2;             // downward acceleration of the trunk; recorded leaps: 2.0
  double trunk_mps = 13.0;            // speed of the fastest sprinters
  double wrist_mps = 25.0;
};

// The clip's faults, the worst first. mapped is what to_standard made of the source. Lying and head
// below hips count when they last for the whole clip, and so does a left arm on the side of the
// right leg.
std::vector<ClipFault> check_clip(const Motion& source, const SkeletonMapping& mapping,
                                  const Motion& mapped, const ClipLimits& limits = {});

}  // namespace sparse_mocap
