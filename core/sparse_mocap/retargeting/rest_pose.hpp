// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/retargeting/bone_positions.hpp"

namespace sparse_mocap {

// Upper and lower bone of the limbs with a hinge: knees and elbows.
inline constexpr std::array<std::array<standard_joint::Index, 2>, 4> kHingedLimbs{
    {{standard_joint::lfemur, standard_joint::ltibia},
     {standard_joint::rfemur, standard_joint::rtibia},
     {standard_joint::lhumerus, standard_joint::lradius},
     {standard_joint::rhumerus, standard_joint::rradius}}};

// The pose in which a rig is aligned with the standard skeleton's rest.
struct RestPose {
  JointTransforms transforms;
  // False: the angles at zero are no pose, and this is the frame in which the body stands best.
  bool is_at_zero = true;
  double standing_error_rad = 0.0;
  // The axes (world) about which the limbs of kHingedLimbs bend; zero where that is not known.
  std::array<Vec3, 4> hinges{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

// The pose at zero angles, at the origin.
JointTransforms pose_at_zero(const Motion& source);

// The pose at zero angles when the body stands in it, else the frame that comes nearest to
// standing.
RestPose find_rest_pose(const Motion& source, const BodyJoints& joints);

}  // namespace sparse_mocap
