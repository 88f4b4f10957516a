// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "sparse_mocap/motion/humanoid_points.hpp"

namespace sparse_mocap {

// A joint of the source that moves a bone of the standard skeleton, or a part of it.
struct Carrier {
  int joint = -1;
  double weight = 1.0;  // the carriers' weights sum to one
  // The standard joint's world rotation = the source joint's * R_joint_standard.
  Mat3 R_joint_standard = Mat3::Identity();
};

// The carriers of each standard joint; none where it follows its parent.
using Carriers = std::array<std::vector<Carrier>, kNumStandardJoints>;

// Exporters have more joints than the standard skeleton along trunk and limbs, or others: a bone
// that runs along several of theirs is carried by all of them, each by the share of its length.
// points belongs to posture. R_joint_standard is left at identity.
Carriers find_carriers(const Skeleton& source, const SourceJoints& joints,
                       const StandardPoints& points, const JointTransforms& posture);

// The standard joint's world rotation: the carriers' mean (of one alone, exactly its own).
Mat3 carried_rotation(const std::vector<Carrier>& carriers, const std::vector<Mat3>& R_world_joint);

}  // namespace sparse_mocap
