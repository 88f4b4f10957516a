// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/to_standard.hpp"

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
        flexion_(hinge_.cross(upper_bone_).normalized()) {}

  // R_world_upper with the twist that lets the hinge reach `lower` (a direction in the world).
  // A nearly straight limb has no clear plane, so there the twist fades out.
  Mat3 twisted(const Mat3& R_world_upper, const Vec3& lower) const {
    const double kClearPlane = std::sin(5.0 * kRadiansPerDegree);
    const Vec3 l = R_world_upper.transpose() * lower;
    const double forward = l.dot(flexion_);
    const double sideways = (l - lower_bone_).dot(hinge_);
    const double twist =
        std::atan(sideways * forward / (forward * forward + kClearPlane * kClearPlane));
    return R_world_upper * Eigen::AngleAxisd(twist, upper_bone_);
  }

  // The lower bone's world rotation at the hinge's angle that brings it nearest to `lower`.
  Mat3 lower_rotation(const Mat3& R_world_upper, const Vec3& lower) const {
    const Vec3 l = R_world_upper.transpose() * lower;
    const double angle = std::atan2(hinge_.dot(lower_bone_.cross(l)),
                                    lower_bone_.dot(l) - lower_bone_.dot(hinge_) * l.dot(hinge_));
    return R_world_upper * Eigen::AngleAxisd(angle, hinge_);
  }

 private:
  Vec3 upper_bone_, lower_bone_;  // directions in rest
  Vec3 hinge_, flexion_;          // the hinge's axis; where the lower bone goes when it bends
};

// Puts one frame after another on the standard skeleton.
class ToStandard {
 public:
  ToStandard(const SkeletonMapping& mapping, const Skeleton& standard)
      : pelvis_(mapping.joints.standard[root]),
        standard_(standard),
        joint_mapping_(aligned_to(mapping, standard)),
        roots_(align_roots(mapping, standard)),
        angles_(kNumStandardAngles, 0.0) {
    R_world_.fill(Mat3::Identity());
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
    // The hips are what stands on the legs: they are laid where the source has them.
    out.root_positions.push_back(roots_.standard_per_rig * source.pivot[at(pelvis_)] +
                                 R_world_[root] * roots_.root_from_pelvis);
  }

 private:
  // The source's world rotation on the standard joint's axes; nothing where the joint follows its
  // parent.
  std::optional<Mat3> wanted_rotation(const JointTransforms& source, int j,
                                      const Mat3& R_world_parent) const {
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
  std::array<Mat3, kNumStandardJoints> R_world_;
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
