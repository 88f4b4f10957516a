// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// The names of a rig's joints by standard joint, as people write them by hand. lfoot and rfoot,
// whose joints the standard skeleton lacks, are the ankles, where the shanks end.
using JointNames = std::map<std::string, std::string>;
inline constexpr std::array<const char*, 2> kAnkleNames{"lfoot", "rfoot"};

// A rig's joints of a human body; -1: there is none.
struct BodyJoints {
  std::array<int, kNumStandardJoints> standard;  // of each standard joint
  std::array<int, 2> ankle{-1, -1};              // left, right
  bool has_head_tip = true;  // false: what hangs on the head is a jaw or eyes, not its top
  std::array<bool, 2> has_hand_tip{true, true};
  bool is_by_names = true;  // false: limbs were found by their shape and position
};

// Finds the body's joints: by hand, by names, then by shape in the given pose.
// Throws MappingError naming what is missing, or a name by hand that is not there and the nearest
// that is.
BodyJoints find_body_joints(const Skeleton& rig, const JointTransforms& pose,
                            const JointNames& by_hand);

// Whether a mapping may name it, and the name that is spelt most like it.
bool is_mapped_name(const std::string& name);
std::string nearest_standard_joint(const std::string& name);

// Joints from below `ancestor` down to `joint` inclusive; empty when it is no ancestor.
std::vector<int> path_down(const Skeleton& rig, int ancestor, int joint);

// The last joint on which both hang; -1 when either is -1.
int common_ancestor(const Skeleton& rig, int a, int b);

}  // namespace sparse_mocap
