// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/to_rig.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "sparse_mocap/retargeting/rest_alignment.hpp"

namespace sparse_mocap {
namespace {

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// A standard joint that turns a joint of the rig: R_world_joint = R_world_standard *
// R_standard_joint. The weights of one rig joint need not sum to one.
struct TurningBone {
  int standard = 0;
  double weight = 1.0;
  Mat3 R_standard_joint = Mat3::Identity();
};

// The pelvis is turned by the root alone, though the lower back may begin at it.
bool is_turned_by(const SkeletonMapping& mapping, int joint, int standard) {
  const int pelvis = mapping.joints.standard[standard_joint::root];
  return (joint == pelvis) == (standard == standard_joint::root);
}

// Adds what turns the rig's feet, toes and hands: these alone, where the motion has them.
void add_extremities(const SkeletonMapping& mapping,
                     std::vector<std::vector<TurningBone>>& turning) {
  for (int e = 0; e < kNumExtremities; ++e) {
    const MappedJoint& mapped = mapping.extremities[at(e)];
    if (mapped.joint < 0) continue;
    turning[at(mapped.joint)] = {{extremity_joint(e), 1.0, mapped.R_joint_standard.transpose()}};
  }
}

// The mapping seen from the rig: what turns each of its joints.
std::vector<std::vector<TurningBone>> turning_bones(const SkeletonMapping& mapping,
                                                    const Skeleton& standard, int num_joints) {
  std::vector<std::vector<TurningBone>> turning(at(num_joints));
  const JointMapping aligned = aligned_to(mapping, standard);
  for (int s = 0; s < kNumStandardJoints; ++s) {
    for (const auto& mapped : aligned[at(s)]) {
      if (!is_turned_by(mapping, mapped.joint, s)) continue;
      const double length = s == standard_joint::root ? 1.0 : mapping.bones[at(s)].norm();
      turning[at(mapped.joint)].push_back(
          {s, mapped.weight * length, mapped.R_joint_standard.transpose()});
    }
  }
  if (has_extremities(standard)) add_extremities(mapping, turning);
  return turning;
}

// Puts one frame after another on the rig.
class ToRig {
 public:
  ToRig(const SkeletonMapping& mapping, const Skeleton& standard, const Skeleton& rig)
      : mapping_(mapping),
        rig_(rig),
        turning_(turning_bones(mapping, standard, rig.num_joints())),
        roots_(align_roots(mapping, standard)),
        R_joint_(at(rig.num_joints())) {}

  void add(const JointTransforms& standard, Motion& out) {
    std::vector<Mat3> R_world(at(rig_.num_joints()));
    for (int j = 0; j < rig_.num_joints(); ++j) {
      const int parent = rig_.joint(j).parent;
      const Mat3 R_world_parent = parent < 0 ? Mat3::Identity() : R_world[at(parent)];
      R_joint_[at(j)] = turning_[at(j)].empty()
                            ? mapping_.R_parent_joint_rest[at(j)]
                            : Mat3(R_world_parent.transpose() * world_rotation(standard, j));
      R_world[at(j)] = R_world_parent * R_joint_[at(j)];
      out.rotations.emplace_back(R_joint_[at(j)]);
    }
    out.root_positions.push_back(root_position(standard));
  }

 private:
  // In the rig's own world. The nearest rotation also of a single bone, for rest poses of odd
  // bodies (bones without a length) may be aligned by what is no rotation.
  Mat3 world_rotation(const JointTransforms& standard, int joint) const {
    Mat3 sum = Mat3::Zero();
    for (const auto& bone : turning_[at(joint)])
      sum += bone.weight * standard.R_world_joint[at(bone.standard)] * bone.R_standard_joint;
    return nearest_rotation(mapping_.R_world_file.transpose() * sum);
  }

  // Where the rig's root has to be for its pelvis to be where the standard's is.
  Vec3 root_position(const JointTransforms& standard) {
    constexpr auto kRoot = standard_joint::root;
    const Vec3 pelvis =
        (standard.pivot[kRoot] - standard.R_world_joint[kRoot] * roots_.root_from_pelvis) /
        roots_.standard_per_rig;
    forward_kinematics(rig_, Vec3::Zero(), R_joint_, transforms_);
    return mapping_.R_world_file.transpose() * pelvis -
           transforms_.pivot[at(mapping_.joints.standard[kRoot])];
  }

  const SkeletonMapping& mapping_;
  const Skeleton& rig_;
  std::vector<std::vector<TurningBone>> turning_;
  RootAlignment roots_;
  std::vector<Mat3> R_joint_;
  JointTransforms transforms_;
};

}  // namespace

Motion to_rig(const Motion& motion, const SkeletonMapping& mapping, const Skeleton& rig) {
  if (mapping.R_parent_joint_rest.size() != rig.joints().size())
    throw std::invalid_argument("to_rig: the mapping was found for a rig with other joints");
  if (motion.skeleton.num_joints() != kNumStandardJoints && !has_extremities(motion.skeleton))
    throw std::invalid_argument("to_rig: the motion is not on a standard skeleton");
  Motion out;
  out.skeleton = rig;
  out.frame_time_s = motion.frame_time_s;
  ToRig frames(mapping, motion.skeleton, rig);
  for (int t = 0; t < motion.num_frames(); ++t) frames.add(motion.transforms(t), out);
  return out;
}

std::vector<int> turned_joints(const SkeletonMapping& mapping) {
  std::set<int> turned;
  for (int s = 0; s < kNumStandardJoints; ++s)
    for (const auto& mapped : mapping.joint_mapping[at(s)])
      if (is_turned_by(mapping, mapped.joint, s)) turned.insert(mapped.joint);
  for (const auto& mapped : mapping.extremities)
    if (mapped.joint >= 0) turned.insert(mapped.joint);
  return {turned.begin(), turned.end()};
}

}  // namespace sparse_mocap
