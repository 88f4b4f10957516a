// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "sparse_mocap/retargeting/bone_positions.hpp"

namespace sparse_mocap {

// A joint of the rig that turns a bone of the standard skeleton, or a part of it.
struct MappedJoint {
  int joint = -1;
  double weight = 1.0;  // the weights of one standard joint sum to one
  // With the rest poses aligned, R_world_standard = R_world_joint * R_joint_standard.
  Mat3 R_joint_standard = Mat3::Identity();
};

// The rig's joints for each standard joint; none where it follows its parent.
using JointMapping = std::array<std::vector<MappedJoint>, kNumStandardJoints>;

// Rigs have more joints than the standard skeleton along trunk and limbs, or others: a bone that
// runs along several of theirs is turned by all of them, each weighted by its share of the length.
// bones belongs to pose. R_joint_standard is left at identity.
JointMapping find_joint_mapping(const Skeleton& rig, const BodyJoints& joints,
                                const BonePositions& bones, const JointTransforms& pose);

// The standard joint's world rotation: the weighted mean over its joints (of one alone, exactly its
// own).
Mat3 mapped_rotation(const std::vector<MappedJoint>& joints,
                     const std::vector<Mat3>& R_world_joint);

// The rotation nearest to a weighted sum of rotations (the chordal mean, Moakher 2002).
Mat3 nearest_rotation(const Mat3& sum);

}  // namespace sparse_mocap
