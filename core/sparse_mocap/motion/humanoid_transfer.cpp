// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <optional>

#include "sparse_mocap/motion/humanoid.hpp"
#include "sparse_mocap/motion/humanoid_rest.hpp"
#include "sparse_mocap/motion/humanoid_units.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

// A limb of the standard skeleton: a ball joint and, at the end of its bone, a hinge.
//
// Where the source's elbow or knee is a hinge too, nothing is to be done. Where it is a ball joint
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
  // A nearly straight limb does not tell its plane, so there the twist fades out.
  Mat3 twisted(const Mat3& R_world_upper, const Vec3& lower) const {
    const double kPlaneIsTold = std::sin(5.0 * kRadiansPerDegree);
    const Vec3 l = R_world_upper.transpose() * lower;
    const double forward = l.dot(flexion_);
    const double sideways = (l - lower_bone_).dot(hinge_);
    const double twist =
        std::atan(sideways * forward / (forward * forward + kPlaneIsTold * kPlaneIsTold));
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

// Carries one frame after another from the source to the standard skeleton.
class Transfer {
 public:
  Transfer(const HumanoidMapping& mapping, const Skeleton& standard)
      : mapping_(mapping),
        standard_(standard),
        carriers_(mapping.carriers),
        angles_(kNumStandardAngles, 0.0) {
    R_world_.fill(Mat3::Identity());
    for (const auto& [upper, lower] : kHingedLimbs) {
      limbs_.emplace_back(standard.joint(upper), standard.joint(lower));
      // Bodies differ in how their limbs lie in the rest pose, which is not meant as movement.
      for (const auto j : {upper, lower})
        for (auto& carrier : carriers_[j])
          carrier.R_joint_standard *= smallest_rotation(standard.joint(j).bone, mapping.bones[j]);
    }
    scale_ = mapping.unit_scale * leg_length_m(bones_of(standard)) / leg_length_m(mapping.bones);
    root_from_hips_ =
        0.5 * (scale_ / mapping.unit_scale * (mapping.bones[lhipjoint] + mapping.bones[rhipjoint]) -
               (standard.joint(lhipjoint).bone + standard.joint(rhipjoint).bone));
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
    out.root_positions.push_back(scale_ * source.pivot[at(mapping_.source.standard[root])] +
                                 R_world_[root] * root_from_hips_);
  }

 private:
  // The source's world rotation on the standard joint's axes; nothing where the joint follows its
  // parent.
  std::optional<Mat3> wanted_rotation(const JointTransforms& source, int j,
                                      const Mat3& R_world_parent) const {
    const auto& carriers = carriers_[at(j)];
    if (carriers.empty()) return std::nullopt;
    const Mat3 wanted = carried_rotation(carriers, source.R_world_joint);
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
    const Mat3 R = carried_rotation(carriers_[lower], source.R_world_joint);
    return (R * standard_.joint(lower).bone).normalized();
  }

  const HumanoidMapping& mapping_;
  const Skeleton& standard_;
  Carriers carriers_;
  std::vector<Limb> limbs_;
  double scale_ = 1.0;
  Vec3 root_from_hips_;
  std::array<Mat3, kNumStandardJoints> R_world_;
  std::vector<double> angles_;
};

void turn_world(const Mat3& R_world_file, JointTransforms& transforms) {
  for (auto& R_world_joint : transforms.R_world_joint) R_world_joint = R_world_file * R_world_joint;
  for (auto* positions : {&transforms.pivot, &transforms.end})
    for (auto& p : *positions) p = R_world_file * p;
}

}  // namespace

Motion to_standard(const Motion& file, const HumanoidMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings) {
  const Motion source = with_sound_offsets(file);
  Motion out;
  out.skeleton = standard;
  out.frame_time_s = source.frame_time_s;
  const int begin = num_leading_rest_frames(source);
  if (begin > 0 && warnings != nullptr)
    warnings->push_back("a leading rest pose was dropped, frames: " + std::to_string(begin));
  Transfer transfer(mapping, standard);
  const bool is_turned = !mapping.R_world_file.isIdentity();
  for (int t = begin; t < source.num_frames(); ++t) {
    JointTransforms transforms = source.transforms(t);
    if (is_turned) turn_world(mapping.R_world_file, transforms);
    transfer.add(transforms, out);
  }
  return out;
}

}  // namespace sparse_mocap
