// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/motion/humanoid_rest.hpp"
#include "sparse_mocap/motion/humanoid_units.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

// Exporters write some bones without a length; the template's is scaled to the body.
void fill_missing_bones(HumanoidMapping& mapping) {
  constexpr double kNoBone_m = 1e-3;
  const double scale = leg_length_m(mapping.bones) / leg_length_m(template_bones());
  for (std::size_t j = 1; j < mapping.bones.size(); ++j)
    if (mapping.bones[j].norm() < kNoBone_m) mapping.bones[j] = scale * template_bones()[j];
}

std::string percent(double ratio) { return std::to_string(std::lround(100.0 * ratio)) + " %"; }

// Proportions that no person has: an animal, or a rig of something else with human names.
void check_proportions(const StandardPoints& points) {
  const auto length = [&](std::initializer_list<Index> bones) {
    double sum = 0.0;
    for (const auto bone : bones) sum += points.bone(bone).norm();
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
  check("the trunk's length by the legs'", 2.0 * points.up.norm() / (left + right), 0.25, 1.3);
}

// On all fours both arms and legs hang across the trunk, whatever the animal is doing.
void check_upright(const StandardPoints& points, const RestPosture& rest) {
  if (rest.standing_error_rad < kStanding_rad) return;
  const Vec3 up = points.up.normalized();
  bool is_across = true;
  for (const auto limb : {lfemur, rfemur, lhumerus, rhumerus})
    is_across = is_across && std::abs(points.bone(limb).normalized().dot(up)) < 0.6;
  const double together = points.bone(lfemur).normalized().dot(points.bone(lhumerus).normalized());
  if (is_across && together > 0.5)
    throw MappingError("not a human body: legs and arms hang across the trunk as an animal's do");
}

// Toes that point backwards mean that left and right are swapped, or that the names lie.
void check_feet(const StandardPoints& points, std::vector<std::string>& warnings) {
  const Vec3 forward = points.left_hips.cross(points.up).normalized();
  constexpr double kBackwards = -0.5;
  const auto is_backward = [&](const Vec3& foot) {
    return foot.norm() > 0.0 && foot.normalized().dot(forward) < kBackwards;
  };
  if (is_backward(points.foot[0]) && is_backward(points.foot[1]))
    warnings.emplace_back("the feet point backwards: left and right may be swapped");
}

}  // namespace

HumanoidMapping map_humanoid(const Motion& file, const JointNames& by_hand) {
  HumanoidMapping mapping;
  int num_dropped = 0;
  const Motion source = with_sound_offsets(file, &num_dropped);
  if (num_dropped > 0)
    mapping.warnings.push_back(
        "position channels are taken as relative to their offsets, joints: " +
        std::to_string(num_dropped));
  const Skeleton& skeleton = source.skeleton;
  mapping.source = find_source_joints(skeleton, pose_at_zero(source), by_hand);
  const RestPosture rest = find_rest_posture(source, mapping.source);
  const StandardPoints points = standard_points(skeleton, mapping.source, rest.transforms);
  drop_odd_tips(points, mapping.source);
  check_proportions(points);
  check_upright(points, rest);
  if (!mapping.source.is_by_names)
    mapping.warnings.emplace_back("limbs were recognised by their shape, not by their names");
  if (!rest.is_at_zero)
    mapping.warnings.emplace_back(
        "the angles at zero are no standing pose: the body was matched in the frame where it "
        "stands best");
  if (rest.standing_error_rad >= kStanding_rad)
    mapping.warnings.emplace_back("the body never stands: how its limbs are twisted is a guess");
  check_feet(points, mapping.warnings);
  const double leg_m = 0.5 * (points.bone(lfemur).norm() + points.bone(ltibia).norm() +
                              points.bone(rfemur).norm() + points.bone(rtibia).norm());
  mapping.unit_scale = guessed_unit_scale(leg_m, mapping.warnings);
  mapping.R_world_file = guessed_world(source, mapping.source, rest, mapping.warnings);
  match_rest(skeleton, rest, mapping);
  fill_missing_bones(mapping);
  return mapping;
}

HumanoidMapping map_humanoid(const Skeleton& source, const JointNames& by_hand) {
  Motion still;
  still.skeleton = source;
  return map_humanoid(still, by_hand);
}

Eigen::MatrixXd standard_angles(const Motion& motion) {
  Eigen::MatrixXd angles = Eigen::MatrixXd::Zero(kNumStandardAngles, motion.num_frames());
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j) {
      const int begin = motion.skeleton.angle_begin(j);
      const double* reference = t > 0 ? &angles(begin, t - 1) : nullptr;
      joint_angles(motion.skeleton.joint(j), motion.rotation(t, j).toRotationMatrix(), reference,
                   &angles(begin, t));
    }
  }
  return angles;
}

}  // namespace sparse_mocap
