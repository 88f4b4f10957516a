// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/to_standard.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sparse_mocap/retargeting/rest_alignment.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// A limb of the standard skeleton: a ball joint and, at the end of its bone, a hinge.
//
// Where the source's elbow or knee is a hinge too, nothing changes. Where it is a ball joint
// its lower bone may leave the plane in which the hinge moves; the upper bone then twists about
// itself, which leaves its direction as it is, until the plane holds the lower bone.
class Limb {
 public:
  Limb(const Joint& upper, const Joint& lower)
      : upper_bone_(upper.bone.normalized()),
        lower_bone_(lower.bone.normalized()),
        hinge_(lower.R_joint_axes * unit(lower.axes.front())),
        across_((hinge_ - upper_bone_ * upper_bone_.dot(hinge_)).normalized()),
        flexion_(across_.cross(upper_bone_)) {}

  // R_world_upper with the twist that lets the hinge reach `lower` (a direction in the world).
  // Two twists do, half a turn apart: that in which the limb bends forward, unless the frame before
  // was near the other and the limb is only a little overstretched. Files turn a thigh about itself
  // where a knee is bent far, and the knee the other way. A nearly straight limb has no clear
  // plane, so there the twist fades out.
  Mat3 twisted(const Mat3& R_world_upper, const Vec3& lower) {
    constexpr double kForward_rad = 20.0 * kRadiansPerDegree;  // how much nearer that one counts
    constexpr double kOverstretched_rad = 90.0 * kRadiansPerDegree;  // at most
    const double kClearPlane = std::pow(std::sin(5.0 * kRadiansPerDegree), 4);
    const Vec3 l = R_world_upper.transpose() * lower;
    // After a twist t the part of `lower` across the hinge's plane is across cos t - flexion sin t;
    // a hinge holds what that is in its rest.
    const double across = l.dot(across_), flexion = l.dot(flexion_);
    const double held = (lower_bone_.dot(hinge_) - l.dot(upper_bone_) * upper_bone_.dot(hinge_)) /
                        across_.dot(hinge_);
    const double bend = std::hypot(across, flexion);
    const double clear = std::max(0.0, bend * bend - held * held);
    const double middle = -std::atan2(flexion, across);
    const double half = std::atan2(std::sqrt(clear), held);
    const bool is_forward =
        std::atan2(bend, l.dot(upper_bone_)) > kOverstretched_rad ||
        std::abs(turn_to(middle + half)) - kForward_rad <= std::abs(turn_to(middle - half));
    twist_ = std::remainder(is_forward ? middle + half : middle - half, 2.0 * kPi) * clear * clear /
             (clear * clear + kClearPlane);
    return R_world_upper * Eigen::AngleAxisd(twist_, upper_bone_);
  }

  // The lower bone's world rotation at the hinge's angle that brings it nearest to `lower`.
  Mat3 lower_rotation(const Mat3& R_world_upper, const Vec3& lower) const {
    const Vec3 l = R_world_upper.transpose() * lower;
    const double angle = std::atan2(hinge_.dot(lower_bone_.cross(l)),
                                    lower_bone_.dot(l) - lower_bone_.dot(hinge_) * l.dot(hinge_));
    return R_world_upper * Eigen::AngleAxisd(angle, hinge_);
  }

 private:
  // From the twist of the frame before to another, the short way round.
  double turn_to(double twist) const { return std::remainder(twist - twist_, 2.0 * kPi); }

  Vec3 upper_bone_, lower_bone_;  // directions in rest
  Vec3 hinge_;                    // its axis
  Vec3 across_, flexion_;         // across the upper bone: along the hinge; where the limb bends to
  double twist_ = 0.0;            // of the upper bone in this frame, rad
};

// Puts one frame after another on the standard skeleton.
class ToStandard {
 public:
  ToStandard(const SkeletonMapping& mapping, const Skeleton& standard)
      : pelvis_(mapping.joints.standard[root]),
        standard_(standard),
        joint_mapping_(aligned_to(mapping, standard)),
        roots_(align_roots(mapping, standard)),
        extremities_(mapping.extremities),
        R_world_(static_cast<std::size_t>(standard.num_joints()), Mat3::Identity()),
        angles_(kNumStandardAngles, 0.0) {
    for (const auto& [upper, lower] : kHingedLimbs)
      limbs_.emplace_back(standard.joint(upper), standard.joint(lower));
  }

  void add(const JointTransforms& source, Motion& out) {
    for (int j = 0; j < kNumStandardJoints; ++j) {
      const int parent = standard_.joint(j).parent;
      const Mat3 R_world_parent = parent < 0 ? Mat3::Identity() : R_world_[at(parent)];
      Mat3 R_joint = Mat3::Identity();
      if (const auto wanted = wanted_rotation(source, j, R_world_parent)) {
        double* joint_angle = angles_.data() + standard_.angle_begin(j);
        joint_angles(standard_.joint(j), R_world_parent.transpose() * *wanted, joint_angle,
                     joint_angle);
        R_joint = joint_rotation(standard_.joint(j), joint_angle);
      }
      R_world_[at(j)] = R_world_parent * R_joint;
      out.rotations.emplace_back(R_joint);
    }
    if (has_extremities(standard_)) add_extremities(source, out);
    // The hips are what stands on the legs: they are laid where the source has them.
    out.root_positions.push_back(roots_.standard_per_rig * source.pivot[at(pelvis_)] +
                                 R_world_[root] * roots_.root_from_pelvis);
  }

 private:
  // Those that the source lacks do nothing.
  void add_extremities(const JointTransforms& source, Motion& out) {
    for (int e = 0; e < kNumExtremities; ++e) {
      const auto index = static_cast<extremity::Index>(e);
      const MappedJoint& mapped = extremities_[at(e)];
      const Mat3& R_world_parent = R_world_[at(extremity_parent(index))];
      const Mat3 R_joint =
          mapped.joint < 0 ? relaxed(standard_, index)
                           : Mat3(R_world_parent.transpose() *
                                  source.R_world_joint[at(mapped.joint)] * mapped.R_joint_standard);
      R_world_[at(extremity_joint(e))] = R_world_parent * R_joint;
      out.rotations.push_back(Quat(R_joint).normalized());
    }
  }

  // The source's world rotation on the standard joint's axes; nothing where the joint follows its
  // parent.
  std::optional<Mat3> wanted_rotation(const JointTransforms& source, int j,
                                      const Mat3& R_world_parent) {
    const auto& joints = joint_mapping_[at(j)];
    if (joints.empty()) return std::nullopt;
    const Mat3 wanted = mapped_rotation(joints, source.R_world_joint);
    for (std::size_t i = 0; i < kHingedLimbs.size(); ++i) {
      const auto [upper, lower] = kHingedLimbs[i];
      if (j != upper && j != lower) continue;
      const Vec3 lower_world = lower_direction(source, lower);
      return j == upper ? limbs_[i].twisted(wanted, lower_world)
                        : limbs_[i].lower_rotation(R_world_parent, lower_world);
    }
    return wanted;
  }

  Vec3 lower_direction(const JointTransforms& source, Index lower) const {
    const Mat3 R = mapped_rotation(joint_mapping_[lower], source.R_world_joint);
    return (R * standard_.joint(lower).bone).normalized();
  }

  int pelvis_;
  const Skeleton& standard_;
  JointMapping joint_mapping_;
  RootAlignment roots_;
  std::vector<Limb> limbs_;
  const ExtremityMapping& extremities_;
  std::vector<Mat3> R_world_;
  std::vector<double> angles_;
};

void turn_world(const Mat3& R_world_file, JointTransforms& transforms) {
  for (auto& R_world_joint : transforms.R_world_joint) R_world_joint = R_world_file * R_world_joint;
  for (auto* positions : {&transforms.pivot, &transforms.end})
    for (auto& p : *positions) p = R_world_file * p;
}

}  // namespace

Motion to_standard(const Motion& file, const SkeletonMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings) {
  const Motion source = without_collapsed_offsets(file);
  Motion out;
  out.skeleton = standard;
  out.frame_time_s = source.frame_time_s;
  const int begin = num_leading_rest_frames(source);
  if (begin > 0 && warnings != nullptr)
    warnings->push_back("a leading rest pose was dropped, frames: " + std::to_string(begin));
  ToStandard frames(mapping, standard);
  const bool is_turned = !mapping.R_world_file.isIdentity();
  for (int t = begin; t < source.num_frames(); ++t) {
    JointTransforms transforms = source.transforms(t);
    if (is_turned) turn_world(mapping.R_world_file, transforms);
    frames.add(transforms, out);
  }
  return out;
}

}  // namespace sparse_mocap
