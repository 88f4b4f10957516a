// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid_posture.hpp"

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

// Tells about which axis each limb bends in a motion, seen from its upper joint's frame.
class HingeFinder {
 public:
  explicit HingeFinder(const SourceJoints& joints) : joints_(joints) {
    sum_.fill(Vec3::Zero());
    bends_.fill(0.0);
  }

  void add(const StandardPoints& points, const JointTransforms& posture) {
    for (std::size_t i = 0; i < kHingedLimbs.size(); ++i) {
      const auto& [upper, lower] = kHingedLimbs[i];
      const Vec3 bend = points.bone(upper).normalized().cross(points.bone(lower).normalized());
      sum_[i] += R_world_upper(i, posture).transpose() * bend;
      bends_[i] += bend.norm();
    }
    ++count_;
  }

  // In the world, in a posture; zero where the movement does not tell.
  std::array<Vec3, 4> axes(const JointTransforms& posture) const {
    // Less bend, or less steady, may be how a straight limb trembles.
    constexpr double kBent_rad = 10.0 * kRadiansPerDegree, kSteady = 0.8;
    std::array<Vec3, 4> axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const bool is_told =
          bends_[i] > std::sin(kBent_rad) * count_ && sum_[i].norm() > kSteady * bends_[i];
      axes[i] = is_told ? Vec3(R_world_upper(i, posture) * sum_[i].normalized()) : Vec3::Zero();
    }
    return axes;
  }

 private:
  const Mat3& R_world_upper(std::size_t limb, const JointTransforms& posture) const {
    const int upper = joints_.standard[kHingedLimbs[limb][0]];
    return posture.R_world_joint[static_cast<std::size_t>(upper)];
  }

  const SourceJoints& joints_;
  std::array<Vec3, 4> sum_;
  std::array<double, 4> bends_;
  int count_ = 0;
};

}  // namespace

JointTransforms pose_at_zero(const Motion& source) { return one_at_zero(source).transforms(0); }

RestPosture find_rest_posture(const Motion& source, const SourceJoints& joints) {
  constexpr int kMostFrames = 200;
  RestPosture best{pose_at_zero(source)};
  best.standing_error_rad =
      standing_error_rad(standard_points(source.skeleton, joints, best.transforms));
  if (best.standing_error_rad < kStanding_rad) return best;
  const int step = std::max(1, source.num_frames() / kMostFrames);
  HingeFinder hinges(joints);
  for (int t = 0; t < source.num_frames(); t += step) {
    const JointTransforms posture = source.transforms(t);
    const StandardPoints points = standard_points(source.skeleton, joints, posture);
    hinges.add(points, posture);
    const double error = standing_error_rad(points);
    if (error < best.standing_error_rad) best = {posture, false, error};
  }
  if (!best.is_at_zero) best.hinges = hinges.axes(best.transforms);
  return best;
}

}  // namespace sparse_mocap
