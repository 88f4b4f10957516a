// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/retargeting/mapping_error.hpp"
#include "sparse_mocap/retargeting/rest_alignment.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"
#include "sparse_mocap/retargeting/units_and_axes.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

// Exporters write some bones without a length; the template's is scaled to the body.
void fill_missing_bones(SkeletonMapping& mapping) {
  constexpr double kNoBone_m = 1e-3;
  const double scale = leg_length_m(mapping.bones) / leg_length_m(template_bones());
  for (std::size_t j = 1; j < mapping.bones.size(); ++j)
    if (mapping.bones[j].norm() < kNoBone_m) mapping.bones[j] = scale * template_bones()[j];
}

std::string percent(double ratio) { return std::to_string(std::lround(100.0 * ratio)) + " %"; }

// Proportions that no person has: an animal, or a rig of something else with human names.
void check_proportions(const BonePositions& bones) {
  const auto length = [&](std::initializer_list<Index> chain) {
    double sum = 0.0;
    for (const auto bone : chain) sum += bones.vector(bone).norm();
    return sum;
  };
  const auto check = [](const char* what, double ratio, double least, double most) {
    if (!(ratio >= least && ratio <= most))
      throw MappingError("not a human body: " + std::string(what) + " is " + percent(ratio) +
                         " (people: " + percent(least) + " to " + percent(most) + ")");
  };
  const double left = length({lfemur, ltibia}), right = length({rfemur, rtibia});
  if (!(left > 0.0 && right > 0.0)) throw MappingError("not a human body: the legs have no length");
  check("the left leg by the right", left / right, 0.75, 1.35);
  check("the shank by the thigh", length({ltibia, rtibia}) / length({lfemur, rfemur}), 0.5, 2.0);
  const double arms = length({lhumerus, lradius, rhumerus, rradius}) / (left + right);
  check("the arms' length by the legs'", arms, 0.3, 1.2);
  check("the trunk's length by the legs'", 2.0 * bones.up.norm() / (left + right), 0.25, 1.3);
}

// On all fours both arms and legs hang across the trunk, whatever the animal is doing.
void check_upright(const BonePositions& bones, const RestPose& rest) {
  if (rest.standing_error_rad < kStanding_rad) return;
  const Vec3 up = bones.up.normalized();
  bool is_across = true;
  for (const auto limb : {lfemur, rfemur, lhumerus, rhumerus})
    is_across = is_across && std::abs(bones.vector(limb).normalized().dot(up)) < 0.6;
  const double together =
      bones.vector(lfemur).normalized().dot(bones.vector(lhumerus).normalized());
  if (is_across && together > 0.5)
    throw MappingError("not a human body: legs and arms hang across the trunk as an animal's do");
}

// Toes that point backwards mean that left and right are swapped, or that the names lie.
void check_feet(const BonePositions& bones, std::vector<std::string>& warnings) {
  const Vec3 forward = bones.left_hips.cross(bones.up).normalized();
  constexpr double kBackwards = -0.5;
  const auto is_backward = [&](const Vec3& foot) {
    return foot.norm() > 0.0 && foot.normalized().dot(forward) < kBackwards;
  };
  if (is_backward(bones.foot[0]) && is_backward(bones.foot[1]))
    warnings.emplace_back("the feet point backwards: left and right may be swapped");
}

}  // namespace

SkeletonMapping map_skeleton(const Motion& file, const JointNames& by_hand) {
  SkeletonMapping mapping;
  int num_dropped = 0;
  const Motion source = without_collapsed_offsets(file, &num_dropped);
  if (num_dropped > 0)
    mapping.warnings.push_back(
        "position channels are taken as relative to their offsets, joints: " +
        std::to_string(num_dropped));
  const Skeleton& rig = source.skeleton;
  mapping.joints = find_body_joints(rig, pose_at_zero(source), by_hand);
  const RestPose rest = find_rest_pose(source, mapping.joints);
  const BonePositions bones = bone_positions(rig, mapping.joints, rest.transforms);
  drop_odd_tips(bones, mapping.joints);
  check_proportions(bones);
  check_upright(bones, rest);
  if (!mapping.joints.is_by_names)
    mapping.warnings.emplace_back("limbs were recognised by their shape, not by their names");
  if (!rest.is_at_zero)
    mapping.warnings.emplace_back(
        "the angles at zero are no standing pose: the body was matched in the frame where it "
        "stands best");
  if (rest.standing_error_rad >= kStanding_rad)
    mapping.warnings.emplace_back("the body never stands: how its limbs are twisted is a guess");
  check_feet(bones, mapping.warnings);
  const double leg_m = 0.5 * (bones.vector(lfemur).norm() + bones.vector(ltibia).norm() +
                              bones.vector(rfemur).norm() + bones.vector(rtibia).norm());
  mapping.unit_scale = guessed_unit_scale(leg_m, mapping.warnings);
  mapping.R_world_file = guessed_world(source, mapping.joints, rest, mapping.warnings);
  align_rest_poses(rig, rest, mapping);
  fill_missing_bones(mapping);
  return mapping;
}

SkeletonMapping map_skeleton(const Skeleton& rig, const JointNames& by_hand) {
  Motion still;
  still.skeleton = rig;
  return map_skeleton(still, by_hand);
}

JointNames mapped_joint_names(const Skeleton& rig, const SkeletonMapping& mapping) {
  JointNames names;
  for (std::size_t j = 0; j < mapping.joints.standard.size(); ++j)
    if (const int joint = mapping.joints.standard[j]; joint >= 0)
      names.emplace(standard_joint_names()[j], rig.joint(joint).name);
  for (std::size_t side = 0; side < kAnkleNames.size(); ++side)
    if (const int ankle = mapping.joints.ankle[side]; ankle >= 0)
      names.emplace(kAnkleNames[side], rig.joint(ankle).name);
  return names;
}

}  // namespace sparse_mocap
