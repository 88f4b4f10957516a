// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/motion/humanoid_names.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// Standard joint names and the source's joints that move them, given by hand.
using JointNames = std::map<std::string, std::string>;

// The source's joints of each standard joint and of the ankles (left, right); -1: there is none.
struct SourceJoints {
  std::array<int, kNumStandardJoints> standard;
  std::array<int, 2> ankle{-1, -1};
  bool has_head_tip = true;  // false: what hangs on the head is a jaw or eyes, not its top
  std::array<bool, 2> has_hand_tip{true, true};
  bool is_by_names = true;  // false: limbs were found by their shape and place
};

// Joints of the parts of a body: [part][left, right, middle], -1 where unknown.
using PartJoints = std::array<std::array<int, 3>, kNumBodyParts>;

int& joint_of(PartJoints& parts, BodyPart part, Side side);

// Finds limbs and head by the tree's shape and where things are: arms and legs are the two pairs of
// long chains that mirror each other, the legs being the longer ones. Fills what is unknown.
void find_parts_by_shape(const Skeleton& source, const JointTransforms& posture, PartJoints& parts);

// Finds the standard joints: by hand, by names, then by shape in the given posture.
// Throws MappingError naming what is missing, or a name by hand that is not there and the nearest
// that is.
SourceJoints find_source_joints(const Skeleton& source, const JointTransforms& posture,
                                const JointNames& by_hand);

// The standard joint whose name is spelt most like this one.
std::string nearest_standard_joint(const std::string& name);

// Joints from below `ancestor` down to `joint` inclusive; empty when it is no ancestor.
std::vector<int> path_down(const Skeleton& source, int ancestor, int joint);

// The last joint on which both hang; -1 when either is -1.
int common_ancestor(const Skeleton& source, int a, int b);

}  // namespace sparse_mocap
