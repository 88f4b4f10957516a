// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// The skeleton on which all of the database lives (Tautges et al. 2011, section 3): HDM05's without
// feet, toes, hands, fingers and thumbs. 21 joints; 40 bone angles and 3 of the root.
inline constexpr int kNumStandardJoints = 21;
inline constexpr int kNumStandardAngles = 43;

namespace standard_joint {
enum Index : int {
  root,
  lhipjoint,
  lfemur,
  ltibia,
  rhipjoint,
  rfemur,
  rtibia,
  lowerback,
  upperback,
  thorax,
  lowerneck,
  upperneck,
  head,
  lclavicle,
  lhumerus,
  lradius,
  lwrist,
  rclavicle,
  rhumerus,
  rradius,
  rwrist
};
}  // namespace standard_joint

const std::array<std::string_view, kNumStandardJoints>& standard_joint_names();

// The bones of one standard skeleton: from pivot to end of each joint, in rest pose (m).
using StandardBones = std::array<Vec3, kNumStandardJoints>;

// A medium body (leg 0.85 m): stands in where a source does not say how long a bone is.
const StandardBones& template_bones();

// Topology, joint axes and names are the standard's; bones give the proportions.
Skeleton make_standard_skeleton(const StandardBones& bones);
StandardBones bones_of(const Skeleton& standard_skeleton);

// The mean of several bodies, made symmetric so that mirrored clips live on it as well.
// Throws std::invalid_argument when there are none.
StandardBones averaged_bones(const std::vector<StandardBones>& bodies);

// For each standard joint the one on the other side.
const std::vector<int>& standard_left_right();

// Thigh and shank, mean of both sides (m).
double leg_length_m(const StandardBones& bones);

}  // namespace sparse_mocap
