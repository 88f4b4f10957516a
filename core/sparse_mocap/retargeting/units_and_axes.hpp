// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/retargeting/rest_pose.hpp"

namespace sparse_mocap {

// The factor that gives legs (m) a human length: 1 when they have one already, else that of a usual
// unit, else what makes them usual legs. What was guessed goes to warnings.
double guessed_unit_scale(double leg_m, std::vector<std::string>& warnings);

// Turns the file's world into one with y up, as rest pose and movement show it; what was guessed
// goes to warnings.
Mat3 guessed_world(const Motion& source, const BodyJoints& joints, const RestPose& rest,
                   std::vector<std::string>& warnings);

}  // namespace sparse_mocap
