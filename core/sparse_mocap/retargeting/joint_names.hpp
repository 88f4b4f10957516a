// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sparse_mocap {

// The parts of a body that joints are named after; spine, neck and clavicles follow from where
// these hang.
enum class BodyPart { thigh, shank, foot, upper_arm, forearm, hand, head };
inline constexpr int kNumBodyParts = 7;

enum class Side { left, right, middle };

// A part that a joint's name may mean, and how good a name for it this is (0: the best; "LeftLeg"
// is a thigh only where nothing better is).
struct NamedPart {
  BodyPart part;
  Side side;
  int rank;
};

// Every part that a joint name may mean: without name space and prefix ("mixamorig:LeftUpLeg",
// "Character1_LeftUpLeg"), however the side is written ("lThigh", "thigh.L", "R_upLeg_jnt").
std::vector<NamedPart> parts_named(std::string_view name);

// The name without side, prefix, separators and capitals; what parts_named looks up.
std::string plain_part_name(std::string_view name, Side& side);

}  // namespace sparse_mocap
