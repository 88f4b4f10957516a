// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "sparse_mocap/motion/joint_rotations.hpp"

namespace sparse_mocap::liu2011 {

// A pose that the performer is asked to imitate (Liu et al. 2011, section 4), facing forward (+z).
struct CalibrationPose {
  std::string_view name;
  std::string_view instruction;
  JointRotations rotations;  // R_joint of the standard skeleton
};

// The eight calibration poses. Together they turn each limb about two axes, and bend elbows, knees,
// hips and trunk, so that lengths and the sensors' places can be told apart.
const std::vector<CalibrationPose>& calibration_poses();

// Throws ConfigError naming the known poses.
int find_calibration_pose(std::string_view name);

}  // namespace sparse_mocap::liu2011
