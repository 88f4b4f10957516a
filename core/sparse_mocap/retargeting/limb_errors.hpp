// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// Thighs, shanks, upper arms and forearms, named by the standard joint.
inline constexpr std::array<standard_joint::Index, 8> kLimbBones{
    standard_joint::lfemur,   standard_joint::ltibia,   standard_joint::rfemur,
    standard_joint::rtibia,   standard_joint::lhumerus, standard_joint::lradius,
    standard_joint::rhumerus, standard_joint::rradius};

// Angles (rad) between a limb of the source and of its movement on the standard skeleton.
struct LimbErrors {
  std::array<double, kLimbBones.size()> mean_rad{}, worst_rad{};

  double overall_mean_rad() const;
  double overall_worst_rad() const;
};

// What to_standard made of a source, frame by frame. The source's limbs point from joint to joint
// (shoulder, elbow, wrist; hip, knee, ankle: the first that is most of the way down, whichever the
// mapping ends at), whatever its joints turn.
// step: every how many frames are compared.
LimbErrors limb_errors(const Motion& source, const SkeletonMapping& mapping, const Motion& mapped,
                       int step = 1);

}  // namespace sparse_mocap
