// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "sparse_mocap/motion/humanoid.hpp"

namespace sparse_mocap {

// A mapping written by hand, or one that was found and saved:
//   {"format": "sparse_mocap_mapping", "format_version": 1, "joints": {"lfemur": "LeftUpLeg", ...}}
// Standard joints that it does not name are found as without it.
// Throws FormatError, also where a standard joint's name is unknown (naming the nearest).
JointNames read_mapping(const std::filesystem::path& path);

// Atomic; throws std::filesystem_error.
void write_mapping(const std::filesystem::path& path, const JointNames& joints);

// Where a folder of mappings keeps the one for a skeleton; named after the skeleton's joints, so
// that every file of one rig finds it.
std::filesystem::path remembered_mapping_path(const std::filesystem::path& folder,
                                              const Skeleton& source);

// The mapping that the folder keeps for a skeleton, empty when there is none.
// Throws FormatError when what is kept cannot be read.
JointNames remembered_mapping(const std::filesystem::path& folder, const Skeleton& source);

// What a user said about bodies, for files of any skeleton.
struct MappingChoice {
  JointNames by_hand;                // for skeletons that have all of these joints
  std::filesystem::path remembered;  // a folder of mappings for others; empty: none
};

// map_humanoid with what was said about such a skeleton; a warning says that it was.
// Throws MappingError, FormatError (a remembered mapping that cannot be read).
HumanoidMapping map_as_chosen(const Motion& source, const MappingChoice& choice);

// The source's joints of a mapping, as read_mapping gives them.
JointNames joint_names(const Skeleton& source, const HumanoidMapping& mapping);

}  // namespace sparse_mocap
