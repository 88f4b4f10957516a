// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a rig and the standard skeleton correspond. A rig is any skeleton of a human body that is not
// the standard one: of a motion file or of an animator's character. The same mapping serves both
// directions, to_standard.hpp and to_rig.hpp.
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/retargeting/extremity_mapping.hpp"
#include "sparse_mocap/retargeting/joint_mapping.hpp"

namespace sparse_mocap {

struct SkeletonMapping {
  // The rig's joints of the body, found by hand, by names or by shape.
  BodyJoints joints;
  // Which of the rig's joints turn each standard joint, with the rest poses aligned.
  JointMapping joint_mapping;
  // Which of them turn feet, toes and hands.
  ExtremityMapping extremities;
  // How each of the rig's joints is turned in its parent while the rig rests. Identity for rigs
  // that stand when all their angles are zero.
  std::vector<Mat3> R_parent_joint_rest;
  // Turns the rig's world into one with y up; identity for most files.
  Mat3 R_world_file = Mat3::Identity();
  // The rig's proportions on the standard topology, m (after unit_scale).
  StandardBones bones;
  // The rig's lengths times this are metres: 1 unless its own unit gives no human size.
  double unit_scale = 1.0;
  std::vector<std::string> warnings;
};

// Finds the body's joints by hand where given, by names, then by shape, and aligns the rest poses
// once. The motion serves where the skeleton alone does not say: which axis is up, and how a body
// stands whose angles at zero are no pose (bones along their joints' own axes).
// Throws MappingError when this is no human body.
SkeletonMapping map_skeleton(const Motion& source, const JointNames& by_hand = {});

// As above from the skeleton alone, whose angles at zero must be a pose.
SkeletonMapping map_skeleton(const Skeleton& rig, const JointNames& by_hand = {});

// The names of the rig's joints in a mapping, by standard joint.
JointNames mapped_joint_names(const Skeleton& rig, const SkeletonMapping& mapping);

}  // namespace sparse_mocap
