// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/rest_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparse_mocap {
namespace {

using namespace standard_joint;

using StandardRotations = std::array<Mat3, kNumStandardJoints>;

// Limbs, whose rest direction differs between a T-pose and an A-pose; the hands last.
constexpr std::array kLimbs{lfemur,  ltibia,   rfemur,  rtibia, lhumerus,
                            lradius, rhumerus, rradius, lwrist, rwrist};
constexpr std::size_t kNumLongLimbs = 8;

// Below this a limb's rest direction is how the actor was measured, above it how the pose is meant.
constexpr double kPoseConvention_rad = 10.0 * kRadiansPerDegree;
// A bone shorter than this part of the thigh has no direction.
constexpr double kNoBone = 1e-3;
// A limb that rests bent by more than this shows its hinge's axis.
constexpr double kBent_rad = 10.0 * kRadiansPerDegree;

// The frame whose x is along a direction and whose y is nearest to another one.
Mat3 frame(const Vec3& along, const Vec3& second) {
  Mat3 R;
  R.col(0) = along.normalized();
  R.col(2) = along.cross(second).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

// The standard joints' world rotations where limbs rest as the standard's do, as in files of HDM05
// and CMU: identity, but for the hands. Nothing where some limb rests elsewhere.
std::optional<StandardRotations> shared_rest(const BonePositions& bones) {
  StandardRotations R_world_standard;
  R_world_standard.fill(Mat3::Identity());
  const double no_bone = kNoBone * bones.vector(lfemur).norm();
  for (std::size_t i = 0; i < kLimbs.size(); ++i) {
    const auto j = kLimbs[i];
    const Vec3 bone = bones.vector(j);
    if (bone.norm() < no_bone) continue;
    if (angle_between(bone, template_bones()[j]) < kPoseConvention_rad) continue;
    if (i < kNumLongLimbs) return std::nullopt;
    R_world_standard[j] = smallest_rotation(template_bones()[j], bone);
  }
  return R_world_standard;
}

// The axis about which exporters' limbs bend in the standard's rest pose: knees as the standard's
// own, elbows forward where arms are held out.
Vec3 usual_hinge(Index lower) {
  if (lower == lradius) return -Vec3::UnitY();
  if (lower == rradius) return Vec3::UnitY();
  return hinge_axis(lower);
}

// Finds for each standard joint the world rotation that brings its rest into the rig's pose.
class RestAligner {
 public:
  RestAligner(const BonePositions& bones, const std::array<Vec3, 4>& hinges)
      : bones_(bones), hinges_(hinges) {
    no_bone_ = kNoBone * bones.vector(lfemur).norm();
    R_.fill(Mat3::Identity());
  }

  StandardRotations align() {
    const StandardBones& rest = template_bones();
    R_[root] = frame(bones_.left_hips, bones_.up) *
               frame(Vec3::UnitX(), rest[lowerback] + rest[upperback] + rest[thorax]).transpose();
    R_[lhipjoint] = R_[rhipjoint] = R_[root];
    align_spine();
    for (const auto j : {lowerneck, upperneck}) swing(j, R_[thorax]);
    swing(head, R_[thorax]);
    align_limb(0, R_[root]);
    align_limb(1, R_[root]);
    for (const auto j : {lclavicle, rclavicle}) swing(j, R_[thorax]);
    align_hand(lwrist, lhumerus, lradius);
    align_hand(rwrist, rhumerus, rradius);
    align_limb(2, R_[thorax]);
    align_limb(3, R_[thorax]);
    return R_;
  }

 private:
  bool has(Index j) const { return bones_.vector(j).norm() > no_bone_; }

  // From a frame by the smallest turn that lays the standard's bone on the rig's.
  void swing(Index j, const Mat3& R_from) {
    R_[j] = R_from;
    if (has(j)) R_[j] = smallest_rotation(R_from * template_bones()[j], bones_.vector(j)) * R_from;
  }

  void align_spine() {
    const Vec3 hips = bones_.left_hips.normalized();
    const Vec3 shoulders = bones_.left_shoulders.normalized();
    for (const auto& [j, left] : {std::pair<Index, Vec3>{lowerback, hips},
                                  {upperback, hips + shoulders},
                                  {thorax, shoulders}}) {
      R_[j] = R_[root];
      if (has(j))
        R_[j] =
            frame(bones_.vector(j), left) * frame(template_bones()[j], Vec3::UnitX()).transpose();
    }
  }

  // The hinge's axis is the one about which the rig bends the limb, if that is known; else that of
  // the bend in this pose; else exporters' knees bend as the standard's do, and elbows forward
  // where arms are held out.
  void align_limb(std::size_t limb, const Mat3& R_from) {
    const auto& [upper, lower] = kHingedLimbs[limb];
    swing(upper, R_from);
    Vec3 axis = R_[upper] * usual_hinge(lower);
    const Vec3 bend = bones_.vector(upper).cross(bones_.vector(lower));
    if (!hinges_[limb].isZero()) {
      axis = hinges_[limb];
    } else if (angle_between(bones_.vector(upper), bones_.vector(lower)) > kBent_rad &&
               bend.dot(axis) > 0.0) {
      axis = bend;
    }
    R_[upper] = frame(bones_.vector(upper), axis) *
                frame(template_bones()[upper], hinge_axis(lower)).transpose();
    swing(lower, R_[upper]);
  }

  // Palms rest down where arms are held out, whatever the elbow's axis is called.
  void align_hand(Index wrist, Index humerus, Index radius) {
    swing(humerus, R_[thorax]);
    swing(radius, R_[humerus]);
    swing(wrist, R_[radius]);
  }

  const BonePositions& bones_;
  const std::array<Vec3, 4>& hinges_;
  StandardRotations R_;
  double no_bone_ = 0.0;
};

// The direction beside the bone that fixes a joint's twist, in the standard's rest.
Vec3 second_direction(Index j) {
  switch (j) {
    case lfemur:
    case ltibia:
      return hinge_axis(ltibia);
    case rfemur:
    case rtibia:
      return hinge_axis(rtibia);
    case lhumerus:
    case lradius:
    case lwrist:
      return hinge_axis(lradius);
    case rhumerus:
    case rradius:
    case rwrist:
      return hinge_axis(rradius);
    case lclavicle:
    case rclavicle:
      return Vec3::UnitY();
    default:
      return Vec3::UnitX();
  }
}

const Skeleton& template_skeleton() {
  static const Skeleton skeleton = make_standard_skeleton(template_bones());
  return skeleton;
}

Vec3 nearest_axis(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return direction[axis] > 0.0 ? Vec3(Vec3::Unit(axis)) : Vec3(-Vec3::Unit(axis));
}

// Rigs whose angles at zero are no pose have their bones along axes of their joints, and then also
// their hinges: the nearest axes are the same for every clip, the frame they were found in is not.
void snap_to_joint_axes(Index j, Mat3& R_joint_standard) {
  constexpr double kNearest_rad = 45.0 * kRadiansPerDegree, kAlong_rad = 6.0 * kRadiansPerDegree;
  const Vec3 bone = template_bones()[j].isZero() ? Vec3::UnitY() : template_bones()[j];
  const Mat3 R_standard_bone = frame(bone, second_direction(j));
  const Mat3 R_joint_bone = R_joint_standard * R_standard_bone;
  Vec3 along = nearest_axis(R_joint_bone.col(0));
  const Vec3 second = nearest_axis(R_joint_bone.col(1));
  const bool is_limb = std::find(kLimbs.begin(), kLimbs.end() - 2, j) != kLimbs.end() - 2;
  if (is_limb && angle_between(along, R_joint_bone.col(0)) > kAlong_rad)
    along = R_joint_bone.col(0);
  if (along.cross(second).norm() < 0.5) return;
  const Mat3 snapped = frame(along, second);
  if (Eigen::AngleAxisd(snapped.transpose() * R_joint_bone).angle() > kNearest_rad) return;
  R_joint_standard = snapped * R_standard_bone.transpose();
}

// The rig's bones in the frames of the standard joints that it turns.
void measure_bones(const BonePositions& bones, const JointTransforms& pose,
                   SkeletonMapping& mapping) {
  StandardRotations R_world;
  for (std::size_t j = 0; j < kNumStandardJoints; ++j) {
    const auto parent = static_cast<std::size_t>(template_skeleton().joints()[j].parent);
    R_world[j] = mapping.joint_mapping[j].empty()
                     ? R_world[parent]
                     : mapped_rotation(mapping.joint_mapping[j], pose.R_world_joint);
    mapping.bones[j] =
        mapping.unit_scale * R_world[j].transpose() * bones.vector(static_cast<int>(j));
  }
}

// One frame does not show how a hand rests: its joint's axes are taken to be the forearm's.
void align_hand_with_forearm(Index radius, Index wrist, JointMapping& mapped) {
  if (mapped[wrist].empty()) return;
  const Mat3& R_joint_radius = mapped[radius].front().R_joint_standard;
  mapped[wrist].front().R_joint_standard =
      frame(R_joint_radius * template_bones()[radius], R_joint_radius * hinge_axis(radius)) *
      frame(template_bones()[wrist], usual_hinge(radius)).transpose();
}

std::vector<Mat3> rotations_in_parents(const Skeleton& rig, const JointTransforms& pose) {
  std::vector<Mat3> R_parent_joint = pose.R_world_joint;
  for (int j = 1; j < rig.num_joints(); ++j) {
    const auto parent = static_cast<std::size_t>(rig.joint(j).parent);
    auto& R = R_parent_joint[static_cast<std::size_t>(j)];
    R = pose.R_world_joint[parent].transpose() * R;
  }
  return R_parent_joint;
}

}  // namespace

Mat3 smallest_rotation(const Vec3& from, const Vec3& to) {
  return Quat::FromTwoVectors(from, to).toRotationMatrix();
}

Vec3 hinge_axis(Index lower) {
  const Joint& joint = template_skeleton().joint(lower);
  return joint.R_joint_axes * unit(joint.axes.front());
}

void align_rest_poses(const Skeleton& rig, const RestPose& rest, SkeletonMapping& mapping) {
  const BonePositions bones = bone_positions(rig, mapping.joints, rest.transforms);
  std::optional<StandardRotations> shared;
  if (rest.is_at_zero) shared = shared_rest(bones);
  const StandardRotations R_world_standard =
      shared ? *shared : RestAligner(bones, rest.hinges).align();
  mapping.joint_mapping = find_joint_mapping(rig, mapping.joints, bones, rest.transforms);
  for (std::size_t j = 0; j < kNumStandardJoints; ++j) {
    for (auto& mapped : mapping.joint_mapping[j]) {
      const Mat3& R_world_joint =
          rest.transforms.R_world_joint[static_cast<std::size_t>(mapped.joint)];
      mapped.R_joint_standard = R_world_joint.transpose() * R_world_standard[j];
      if (!rest.is_at_zero) snap_to_joint_axes(static_cast<Index>(j), mapped.R_joint_standard);
    }
  }
  if (!rest.is_at_zero) {
    align_hand_with_forearm(lradius, lwrist, mapping.joint_mapping);
    align_hand_with_forearm(rradius, rwrist, mapping.joint_mapping);
  }
  const auto world_wrist = [&](Index wrist) {
    const auto& mapped = mapping.joint_mapping[wrist];
    return mapped.empty() ? R_world_standard[wrist]
                          : mapped_rotation(mapped, rest.transforms.R_world_joint);
  };
  mapping.extremities = map_extremities(rig, mapping.joints, bones, rest.transforms,
                                        {world_wrist(lwrist), world_wrist(rwrist)});
  mapping.R_parent_joint_rest = rotations_in_parents(rig, rest.transforms);
  measure_bones(bones, rest.transforms, mapping);
}

JointMapping aligned_to(const SkeletonMapping& mapping, const Skeleton& standard) {
  JointMapping aligned = mapping.joint_mapping;
  for (const auto& limb : kHingedLimbs)
    for (const auto j : limb)
      for (auto& mapped : aligned[j])
        mapped.R_joint_standard *= smallest_rotation(standard.joint(j).bone, mapping.bones[j]);
  return aligned;
}

RootAlignment align_roots(const SkeletonMapping& mapping, const Skeleton& standard) {
  RootAlignment roots;
  roots.standard_per_rig =
      mapping.unit_scale * leg_length_m(bones_of(standard)) / leg_length_m(mapping.bones);
  roots.root_from_pelvis =
      0.5 * (roots.standard_per_rig / mapping.unit_scale *
                 (mapping.bones[lhipjoint] + mapping.bones[rhipjoint]) -
             (standard.joint(lhipjoint).bone + standard.joint(rhipjoint).bone));
  return roots;
}

}  // namespace sparse_mocap
