// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "sparse_mocap/motion/humanoid.hpp"

namespace sparse_mocap {

// A mapping written by hand, or one that was found and saved:
//   {"format": "sparse_mocap_mapping", "joints": {"lfemur": "LeftUpLeg", ...}}
// Standard joints that it does not name are found as without it.
// Throws FormatError, also where a standard joint's name is unknown (naming the nearest).
JointNames read_mapping(const std::filesystem::path& path);

// Atomic; throws std::filesystem_error.
void write_mapping(const std::filesystem::path& path, const JointNames& joints);

// The source's joints of a mapping, as read_mapping gives them.
JointNames joint_names(const Skeleton& source, const HumanoidMapping& mapping);

}  // namespace sparse_mocap
