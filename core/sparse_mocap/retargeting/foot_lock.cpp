// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/foot_lock.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sparse_mocap/retargeting/two_bone_ik.hpp"

namespace sparse_mocap {
namespace {

constexpr double kFlatten_s = 0.16;  // in which a foot gets flat and leaves the floor
constexpr double kLower_s = 0.16;    // around a stand, in which the pelvis gets lower
constexpr double kReach = 0.998;     // of a leg's length
constexpr double kDeepest = 0.1;     // of a leg's length that the pelvis may be lowered

std::size_t at(int j) { return static_cast<std::size_t>(j); }

struct Leg {
  int thigh = -1, shank = -1, foot = -1;
  double length_m = 0.0;
  Mat3 R_world_flat;       // of the foot at rest
  Vec3 toes;               // direction at rest, along the floor
  std::vector<Vec3> sole;  // the foot's points from the ankle, in the foot's frame
};

JointTransforms at_rest(const Skeleton& rig, const SkeletonMapping& mapping) {
  JointTransforms rest;
  forward_kinematics(rig, Vec3::Zero(), mapping.R_parent_joint_rest, rest);
  return rest;
}

Leg find_leg(const Skeleton& rig, const SkeletonMapping& mapping, std::size_t side) {
  using namespace standard_joint;
  Leg leg;
  leg.thigh = mapping.joints.standard[side == 0 ? lfemur : rfemur];
  leg.shank = mapping.joints.standard[side == 0 ? ltibia : rtibia];
  leg.foot = mapping.joints.ankle[side];
  if (leg.foot < 0) return leg;
  const JointTransforms rest = at_rest(rig, mapping);
  const Vec3 ankle = rest.pivot[at(leg.foot)];
  leg.length_m = (rest.pivot[at(leg.shank)] - rest.pivot[at(leg.thigh)]).norm() +
                 (ankle - rest.pivot[at(leg.shank)]).norm();
  leg.R_world_flat = rest.R_world_joint[at(leg.foot)];
  Vec3 farthest = Vec3::Zero();
  for (int j = leg.foot; j < rig.num_joints(); ++j) {
    if (j != leg.foot && path_down(rig, leg.foot, j).empty()) continue;
    for (const Vec3& point : {rest.pivot[at(j)], rest.end[at(j)]}) {
      const Vec3 from_ankle = point - ankle;
      leg.sole.emplace_back(leg.R_world_flat.transpose() * from_ankle);
      Vec3 along(from_ankle.x(), 0.0, from_ankle.z());
      if (along.norm() > farthest.norm()) farthest = along;
    }
  }
  leg.toes = farthest.norm() > 0.0 ? Vec3(farthest.normalized()) : Vec3::UnitZ();
  return leg;
}

// The heading of the foot against its rest (rad); `before` where it points up or down.
double heading_rad(const Leg& leg, const Mat3& R_world_foot, double before) {
  const Vec3 toes = R_world_foot * leg.R_world_flat.transpose() * leg.toes;
  if (Vec3(toes.x(), 0.0, toes.z()).norm() < 0.2) return before;
  const double yaw = std::atan2(toes.x(), toes.z()) - std::atan2(leg.toes.x(), leg.toes.z());
  return before + std::remainder(yaw - before, 2.0 * kPi);
}

// Turns the foot up or down about its ankle until no point of it is below the floor.
Mat3 lifted_out_of_floor(const Leg& leg, const Vec3& ankle, const Mat3& R_world_foot) {
  constexpr double kNear = 1e-6;
  const Vec3 aside = R_world_foot * leg.R_world_flat.transpose() * leg.toes.cross(kUp);
  Mat3 R = R_world_foot;
  for (const Vec3& point : leg.sole) {
    const Vec3 arm = R * point;
    if (ankle.y() + arm.y() >= 0.0) continue;
    // The height of the point after a turn: up cos(turn) + across sin(turn).
    const double up = arm.y(), across = aside.cross(arm).y();
    const double reach = std::hypot(up, across);
    if (reach < kNear) continue;
    const double middle = std::atan2(across, up);
    const double half = std::acos(std::clamp(-ankle.y() / reach, -1.0, 1.0));
    const double a = std::remainder(middle + half, 2.0 * kPi);
    const double b = std::remainder(middle - half, 2.0 * kPi);
    R = Eigen::AngleAxisd(std::abs(a) < std::abs(b) ? a : b, aside) * R;
  }
  return R;
}

// The largest of the neighbours within some frames, then their Gaussian mean: smooth, and nearly
// nowhere less than the values.
Eigen::VectorXd smooth_cover(const Eigen::VectorXd& values, double reach_frames) {
  const auto n = static_cast<int>(values.size());
  const int reach = std::max(1, static_cast<int>(std::lround(reach_frames)));
  Eigen::VectorXd largest(n), smooth(n);
  for (int t = 0; t < n; ++t) {
    const int begin = std::max(0, t - reach), end = std::min(n, t + reach + 1);
    largest[t] = values.segment(begin, end - begin).maxCoeff();
  }
  for (int t = 0; t < n; ++t) {
    double sum = 0.0, weights = 0.0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = std::exp(-4.0 * k * k / (1.0 * reach * reach));
      sum += weight * largest[std::clamp(t + k, 0, n - 1)];
      weights += weight;
    }
    smooth[t] = sum / weights;
  }
  return smooth;
}

class FootLock {
 public:
  FootLock(const Motion& motion, const SkeletonMapping& mapping, const FootLockOptions& options)
      : options_(options), out_{motion, {}} {
    for (std::size_t side = 0; side < 2; ++side)
      legs_[side] = find_leg(motion.skeleton, mapping, side);
    for (auto& path : ankles_) path.resize(3, motion.num_frames());
    for (auto& path : hips_) path.resize(3, motion.num_frames());
    for (auto& path : headings_) path.setZero(3, motion.num_frames());
    pelvis_ = mapping.joints.standard[standard_joint::root];
  }

  bool has_feet() const { return legs_[0].foot >= 0 && legs_[1].foot >= 0; }

  LockedFeet lock(const Eigen::Matrix2Xd& contacts) {
    const int n = out_.motion.num_frames();
    for (int t = 0; t < n; ++t) {
      const JointTransforms pose = out_.motion.transforms(t);
      for (std::size_t side = 0; side < 2; ++side) {
        ankles_[side].col(t) = pose.pivot[at(legs_[side].foot)];
        hips_[side].col(t) = pose.pivot[at(legs_[side].thigh)];
        headings_[side](0, t) = heading_rad(legs_[side], pose.R_world_joint[at(legs_[side].foot)],
                                            t > 0 ? headings_[side](0, t - 1) : 0.0);
      }
    }
    find_targets(contacts);
    lower_pelvis();
    for (int t = 0; t < n; ++t) bend(t);
    return std::move(out_);
  }

 private:
  void find_targets(const Eigen::Matrix2Xd& contacts) {
    const double height_m = options_.ankle_height_m, dt = out_.motion.frame_time_s;
    for (std::size_t side = 0; side < 2; ++side) {
      const Eigen::VectorXd certainty = contacts.row(static_cast<Eigen::Index>(side)).transpose();
      auto& stands = out_.stands[side];
      stands = find_stands(ankles_[side], certainty, height_m, dt, options_.stands);
      targets_[side] =
          ankles_[side] + options_.strength * stand_corrections(ankles_[side], stands, height_m);
      const auto floor = Eigen::RowVectorXd::Constant(ankles_[side].cols(), height_m);
      const Eigen::RowVectorXd lifted = targets_[side].row(1).cwiseMax(floor);
      targets_[side].row(1) += options_.strength * (lifted - targets_[side].row(1));
      weights_[side] =
          options_.strength * stand_weights(stands, out_.motion.num_frames(), kFlatten_s / dt);
    }
  }

  void lower_pelvis() {
    const auto n = out_.motion.num_frames();
    Eigen::VectorXd needed = Eigen::VectorXd::Zero(n);
    for (std::size_t side = 0; side < 2; ++side) {
      const double reach_m = kReach * legs_[side].length_m;
      for (int t = 0; t < n; ++t) {
        if (weights_[side][t] <= 0.0) continue;
        const Vec3 down = hips_[side].col(t) - targets_[side].col(t);
        const double level_2 = down.x() * down.x() + down.z() * down.z();
        const double highest = std::sqrt(std::max(0.0, reach_m * reach_m - level_2));
        needed[t] = std::max(needed[t], weights_[side][t] * (down.y() - highest));
      }
      needed = needed.cwiseMin(kDeepest * legs_[side].length_m);
    }
    const Eigen::VectorXd lowered = smooth_cover(needed, kLower_s / out_.motion.frame_time_s);
    for (int t = 0; t < n; ++t) out_.motion.root_positions[at(t)] -= lowered[t] * kUp;
  }

  void bend(int t) {
    JointTransforms pose = out_.motion.transforms(t);
    for (std::size_t side = 0; side < 2; ++side) {
      const Leg& leg = legs_[side];
      TwoBoneLimb limb{pose.pivot[at(leg.thigh)], pose.pivot[at(leg.shank)],
                       pose.pivot[at(leg.foot)], pose.R_world_joint[at(leg.thigh)],
                       pose.R_world_joint[at(leg.shank)]};
      const Mat3 R_shank_foot = limb.R_lower.transpose() * pose.R_world_joint[at(leg.foot)];
      reach(targets_[side].col(t), pose.R_world_joint[at(pelvis_)] * Vec3::UnitX(), limb);
      set_world(leg.thigh, t, limb.R_upper, pose);
      set_world(leg.shank, t, limb.R_lower, pose);
      const Mat3 R_swinging = limb.R_lower * R_shank_foot;
      const Quat flat(Mat3(Eigen::AngleAxisd(headings_[side](0, t), kUp) * leg.R_world_flat));
      const Mat3 R_foot(Quat(R_swinging).slerp(weights_[side][t], flat));
      const Mat3 R_free = lifted_out_of_floor(leg, limb.end, R_foot);
      set_world(leg.foot, t, Mat3(Quat(R_foot).slerp(options_.strength, Quat(R_free))), pose);
    }
  }

  void set_world(int joint, int t, const Mat3& R_world_joint, JointTransforms& pose) {
    const int parent = out_.motion.skeleton.joint(joint).parent;
    const Mat3 R_world_parent =
        parent < 0 ? Mat3(Mat3::Identity()) : pose.R_world_joint[at(parent)];
    out_.motion.rotation(t, joint) = Quat(R_world_parent.transpose() * R_world_joint).normalized();
    pose.R_world_joint[at(joint)] = R_world_joint;
  }

  FootLockOptions options_;
  LockedFeet out_;
  std::array<Leg, 2> legs_;
  int pelvis_ = 0;
  std::array<Eigen::Matrix3Xd, 2> ankles_, hips_, targets_;
  std::array<Eigen::Matrix3Xd, 2> headings_;  // rad, in the first row
  std::array<Eigen::VectorXd, 2> weights_;
};

}  // namespace

LockedFeet lock_feet(const Motion& rig_motion, const SkeletonMapping& mapping,
                     const Eigen::Matrix2Xd& contacts, const FootLockOptions& options) {
  if (mapping.R_parent_joint_rest.size() != rig_motion.skeleton.joints().size())
    throw std::invalid_argument("lock_feet: the mapping was found for a rig with other joints");
  if (contacts.cols() != rig_motion.num_frames())
    throw std::invalid_argument("lock_feet: contacts must be one for each frame");
  FootLock lock(rig_motion, mapping, options);
  if (!lock.has_feet() || rig_motion.num_frames() == 0) return {rig_motion, {}};
  return lock.lock(contacts);
}

}  // namespace sparse_mocap
