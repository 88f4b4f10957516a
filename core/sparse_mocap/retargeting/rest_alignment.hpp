// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/retargeting/rest_pose.hpp"
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

namespace sparse_mocap {

// Fills what the rest pose determines: joint_mapping, R_parent_joint_rest and bones (the rig's
// lengths times unit_scale).
void align_rest_poses(const Skeleton& rig, const RestPose& rest, SkeletonMapping& mapping);

// The mapping's joints for a standard skeleton of other proportions: bodies differ in how their
// limbs lie in the rest pose, which is not meant as movement.
JointMapping aligned_to(const SkeletonMapping& mapping, const Skeleton& standard);

// Positions of a standard skeleton's root and of a rig's pelvis.
//   p_standard = standard_per_rig * p_pelvis + R_world_root * root_from_pelvis
struct RootAlignment {
  double standard_per_rig = 1.0;  // the ratio of the legs' lengths, units included
  Vec3 root_from_pelvis;          // m, frame of the standard root; brings the hips together
};
RootAlignment align_roots(const SkeletonMapping& mapping, const Skeleton& standard);

// The smallest rotation that turns one direction into another.
Mat3 smallest_rotation(const Vec3& from, const Vec3& to);

// The axis about which a standard hinge bends, in rest (elbow, knee: the lower limb's joint).
Vec3 hinge_axis(standard_joint::Index lower);

}  // namespace sparse_mocap
