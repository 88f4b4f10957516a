// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// The names under which exporters know a standard joint, most specific first, normalised as
// normalised_joint_name does.
std::span<const std::string_view> known_names(standard_joint::Index joint);

// Lower case, without name space ("mixamorig:Hips" becomes "hips") and without separators.
std::string normalised_joint_name(std::string_view name);

}  // namespace sparse_mocap
