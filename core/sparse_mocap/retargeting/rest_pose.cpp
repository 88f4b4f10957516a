// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/rest_pose.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap {
namespace {

Motion one_at_zero(const Motion& source) {
  Motion rest;
  rest.skeleton = source.skeleton;
  rest.root_positions.assign(1, Vec3::Zero());
  rest.rotations.assign(source.skeleton.joints().size(), Quat::Identity());
  return rest;
}

// Finds the axis about which each limb bends in a motion, in its upper joint's frame.
class HingeFinder {
 public:
  explicit HingeFinder(const BodyJoints& joints) : joints_(joints) {
    sum_.fill(Vec3::Zero());
    bends_.fill(0.0);
  }

  void add(const BonePositions& bones, const JointTransforms& pose) {
    for (std::size_t i = 0; i < kHingedLimbs.size(); ++i) {
      const auto& [upper, lower] = kHingedLimbs[i];
      const Vec3 bend = bones.vector(upper).normalized().cross(bones.vector(lower).normalized());
      sum_[i] += R_world_upper(i, pose).transpose() * bend;
      bends_[i] += bend.norm();
    }
    ++count_;
  }

  // In the world, in a pose; zero where the movement does not show it.
  std::array<Vec3, 4> axes(const JointTransforms& pose) const {
    // Less bend, or less steady, may be how a straight limb trembles.
    constexpr double kBent_rad = 10.0 * kRadiansPerDegree, kSteady = 0.8;
    std::array<Vec3, 4> axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const bool is_known =
          bends_[i] > std::sin(kBent_rad) * count_ && sum_[i].norm() > kSteady * bends_[i];
      axes[i] = is_known ? Vec3(R_world_upper(i, pose) * sum_[i].normalized()) : Vec3::Zero();
    }
    return axes;
  }

 private:
  const Mat3& R_world_upper(std::size_t limb, const JointTransforms& pose) const {
    const int upper = joints_.standard[kHingedLimbs[limb][0]];
    return pose.R_world_joint[static_cast<std::size_t>(upper)];
  }

  const BodyJoints& joints_;
  std::array<Vec3, 4> sum_;
  std::array<double, 4> bends_;
  int count_ = 0;
};

}  // namespace

JointTransforms pose_at_zero(const Motion& source) { return one_at_zero(source).transforms(0); }

RestPose find_rest_pose(const Motion& source, const BodyJoints& joints) {
  constexpr int kMostFrames = 200;
  RestPose best{pose_at_zero(source)};
  best.standing_error_rad =
      standing_error_rad(bone_positions(source.skeleton, joints, best.transforms));
  if (best.standing_error_rad < kStanding_rad) return best;
  const int step = std::max(1, source.num_frames() / kMostFrames);
  HingeFinder hinges(joints);
  for (int t = 0; t < source.num_frames(); t += step) {
    const JointTransforms pose = source.transforms(t);
    const BonePositions bones = bone_positions(source.skeleton, joints, pose);
    hinges.add(bones, pose);
    const double error = standing_error_rad(bones);
    if (error < best.standing_error_rad) best = {pose, false, error};
  }
  if (!best.is_at_zero) best.hinges = hinges.axes(best.transforms);
  return best;
}

}  // namespace sparse_mocap
