// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// A mapping written by hand, or one that was found and saved:
//   {"format": "sparse_mocap_mapping", "format_version": 1, "joints": {"lfemur": "LeftUpLeg", ...}}
// Standard joints that it does not name are found as without it.
// Throws FormatError, also where a standard joint's name is unknown (naming the nearest).
JointNames read_mapping(const std::filesystem::path& path);

// Atomic; throws std::filesystem_error.
void write_mapping(const std::filesystem::path& path, const JointNames& joints);

// Where a folder of mappings keeps the one for a rig; named after the rig's joints, so that every
// file of one rig finds it.
std::filesystem::path remembered_mapping_path(const std::filesystem::path& folder,
                                              const Skeleton& rig);

// The mapping that the folder keeps for a rig, empty when there is none.
// Throws FormatError when what is kept cannot be read.
JointNames remembered_mapping(const std::filesystem::path& folder, const Skeleton& rig);

// All mappings that the folder keeps, by the names of their files without the ending.
// Throws FormatError when one cannot be read.
std::map<std::string, JointNames> remembered_mappings(const std::filesystem::path& folder);

// The mappings that a user wrote by hand, for files of any skeleton.
struct MappingChoice {
  JointNames by_hand;                          // for skeletons that have all of these joints
  std::filesystem::path remembered;            // a folder of mappings for others; empty: none
  std::map<std::string, JointNames> by_rig{};  // or these, as remembered_mappings gives them
};

// map_skeleton with the mapping by hand for such a skeleton; a warning says that there is one.
// Throws MappingError, FormatError (a remembered mapping that cannot be read).
SkeletonMapping map_as_chosen(const Motion& source, const MappingChoice& choice);

}  // namespace sparse_mocap
