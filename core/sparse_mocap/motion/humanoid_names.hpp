// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparse_mocap {

// What names tell about a body; spine, neck and clavicles follow from where these hang.
enum class BodyPart { thigh, shank, foot, upper_arm, forearm, hand, head };
inline constexpr int kNumBodyParts = 7;

enum class Side { left, right, middle };

// What an exporter's joint name says: which part it may be, and how good a name for it this is
// (0: the best; "LeftLeg" is a thigh only where nothing better is).
struct NamedPart {
  BodyPart part;
  Side side;
  int rank;
};

// Every reading of a joint name: without name space and prefix ("mixamorig:LeftUpLeg",
// "Character1_LeftUpLeg"), however the side is written ("lThigh", "thigh.L", "R_upLeg_jnt").
std::vector<NamedPart> read_joint_name(std::string_view name);

// The name without side, prefix, separators and capitals; what read_joint_name looks up.
std::string plain_part_name(std::string_view name, Side& side);

}  // namespace sparse_mocap
