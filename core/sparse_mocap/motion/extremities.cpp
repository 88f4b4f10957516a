// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/extremities.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace sparse_mocap {
namespace {

using namespace standard_joint;

// By the length of the leg, in rest.
const Vec3 kFoot{0.0, -0.058, 0.14}, kToes{0.0, 0.0, 0.075};
constexpr double kHand = 0.15;
constexpr double kRelaxedHand_rad = 12.0 * kRadiansPerDegree;

bool has_standard_names(const Skeleton& skeleton) {
  const auto& names = standard_joint_names();
  return std::equal(names.begin(), names.end(), skeleton.joints().begin(),
                    [](std::string_view name, const Joint& joint) { return joint.name == name; });
}

}  // namespace

const std::array<std::string_view, kNumExtremities>& extremity_names() {
  static constexpr std::array<std::string_view, kNumExtremities> names{"lfoot", "ltoes", "lhand",
                                                                       "rfoot", "rtoes", "rhand"};
  return names;
}

int extremity_parent(extremity::Index e) {
  static constexpr std::array parents{
      static_cast<int>(ltibia), kNumStandardJoints + extremity::lfoot, static_cast<int>(lwrist),
      static_cast<int>(rtibia), kNumStandardJoints + extremity::rfoot, static_cast<int>(rwrist)};
  return parents[static_cast<std::size_t>(e)];
}

bool is_standard(const Skeleton& skeleton) {
  return skeleton.num_joints() == kNumStandardJoints && has_standard_names(skeleton);
}

bool has_extremities(const Skeleton& skeleton) {
  if (skeleton.num_joints() != kNumStandardJoints + kNumExtremities) return false;
  for (int e = 0; e < kNumExtremities; ++e)
    if (skeleton.joint(extremity_joint(e)).name != extremity_names()[static_cast<std::size_t>(e)])
      return false;
  return has_standard_names(skeleton);
}

Skeleton with_extremities(const Skeleton& standard_skeleton) {
  if (!is_standard(standard_skeleton))
    throw std::invalid_argument("with_extremities: not a standard skeleton");
  const double leg_m = leg_length_m(bones_of(standard_skeleton));
  std::vector<Joint> joints = standard_skeleton.joints();
  for (int e = 0; e < kNumExtremities; ++e) {
    const auto index = static_cast<extremity::Index>(e);
    Joint joint;
    joint.name = extremity_names()[static_cast<std::size_t>(e)];
    joint.parent = extremity_parent(index);
    joint.axes = {Axis::z, Axis::y, Axis::x};
    if (index == extremity::lhand || index == extremity::rhand)
      joint.bone =
          kHand * leg_m * template_bones()[static_cast<std::size_t>(joint.parent)].normalized();
    else
      joint.bone = leg_m * (index == extremity::lfoot || index == extremity::rfoot ? kFoot : kToes);
    joints.push_back(std::move(joint));
  }
  return Skeleton(std::move(joints));
}

Skeleton without_extremities(const Skeleton& skeleton) {
  if (!has_extremities(skeleton)) return skeleton;
  return Skeleton({skeleton.joints().begin(), skeleton.joints().begin() + kNumStandardJoints});
}

Motion without_extremities(const Motion& motion) {
  if (!has_extremities(motion.skeleton)) return motion;
  Motion out;
  out.skeleton = without_extremities(motion.skeleton);
  out.frame_time_s = motion.frame_time_s;
  out.root_positions = motion.root_positions;
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int j = 0; j < kNumStandardJoints; ++j) out.rotations.push_back(motion.rotation(t, j));
  return out;
}

const std::vector<int>& left_right_with_extremities() {
  static const auto pairs = [] {
    std::vector<int> out = standard_left_right();
    for (const auto e : {extremity::rfoot, extremity::rtoes, extremity::rhand, extremity::lfoot,
                         extremity::ltoes, extremity::lhand})
      out.push_back(extremity_joint(e));
    return out;
  }();
  return pairs;
}

Vec3 rotation_vector(const Quat& rotation) {
  const Eigen::AngleAxisd turn(rotation.w() < 0.0 ? Quat(-rotation.coeffs()) : rotation);
  return turn.angle() * turn.axis();
}

Quat rotation_of_vector(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle <= 0.0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

Mat3 relaxed(const Skeleton& skeleton, extremity::Index e) {
  const int parent = extremity_parent(e);
  if (e == extremity::lfoot || e == extremity::rfoot)  // level when the shank is vertical
    return Quat::FromTwoVectors(-kUp, skeleton.joint(parent).bone).toRotationMatrix();
  if (e == extremity::ltoes || e == extremity::rtoes) return Mat3::Identity();
  const double side = e == extremity::lhand ? -1.0 : 1.0;  // palms rest down, fingers outward
  return Eigen::AngleAxisd(side * kRelaxedHand_rad, Vec3::UnitZ()).toRotationMatrix();
}

}  // namespace sparse_mocap
