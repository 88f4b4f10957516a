// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/synthesis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sparse_mocap/eom2014/training_sequence.hpp"
#include "sparse_mocap/motion/contacts.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kEvenOver_s = 0.05;  // of corrections of the root, standard deviation

// How far the root has to go into each frame so that the feet that stand stay, 3 x frames.
Eigen::Matrix3Xd counter_steps(const Motion& motion) {
  const Eigen::Matrix2Xd contacts = foot_contacts(motion);
  const int n = motion.num_frames();
  Eigen::Matrix3Xd steps = Eigen::Matrix3Xd::Zero(3, n);
  JointTransforms before = motion.transforms(0);
  for (int t = 1; t < n; ++t) {
    JointTransforms now = motion.transforms(t);
    int standing = 0;
    for (int side = 0; side < 2; ++side) {
      if (contacts(side, t) < 0.5 || contacts(side, t - 1) < 0.5) continue;
      const auto ankle = side == 0 ? standard_joint::ltibia : standard_joint::rtibia;
      steps.col(t) -= now.end[ankle] - before.end[ankle];
      ++standing;
    }
    if (standing > 0) steps.col(t) /= standing;
    steps(1, t) = 0.0;
    before = std::move(now);
  }
  return steps;
}

Vec3 evened(const Eigen::Matrix3Xd& steps, Eigen::Index t, double sigma_frames) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(3.0 * sigma_frames));
  Vec3 sum = Vec3::Zero();
  double total = 0.0;
  for (Eigen::Index by = -reach; by <= reach; ++by) {
    if (t + by < 0 || t + by >= steps.cols()) continue;
    const double distance = static_cast<double>(by) / sigma_frames;
    const double weight = std::exp(-0.5 * distance * distance);
    sum += weight * steps.col(t + by);
    total += weight;
  }
  return sum / total;
}

}  // namespace

Motion motion_of(const Skeleton& skeleton, double rate_hz, const Eigen::MatrixXd& poses,
                 const Eigen::MatrixX3d& root_velocities) {
  Motion motion;
  motion.skeleton = skeleton;
  motion.frame_time_s = 1.0 / rate_hz;
  Vec3 place = Vec3::Zero();
  double yaw_rad = 0.0;
  for (Eigen::Index t = 0; t < poses.rows(); ++t) {
    if (t > 0) {
      const Vec3 velocity(root_velocities(t, 0), 0.0, root_velocities(t, 1));
      place += yaw_rotation(yaw_rad) * velocity / rate_hz;
      yaw_rad += root_velocities(t, 2) / rate_hz;
    }
    const Eigen::VectorXd angles = poses.row(t).head(kNumStandardAngles);
    const auto rotations = pose_rotations(skeleton, angles, yaw_rad);
    motion.rotations.insert(motion.rotations.end(), rotations.begin(), rotations.end());
    motion.root_positions.emplace_back(place.x(), poses(t, kHeightChannel), place.z());
  }
  return motion;
}

void smooth_rotations(Motion& motion, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    const Motion before = motion;
    for (int t = 1; t + 1 < motion.num_frames(); ++t)
      for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
        const Quat middle = before.rotation(t - 1, j).slerp(0.5, before.rotation(t + 1, j));
        motion.rotation(t, j) = before.rotation(t, j).slerp(0.5, middle);
      }
  }
}

void stop_skating(Motion& motion) {
  if (motion.num_frames() < 2) return;
  const Eigen::Matrix3Xd steps = counter_steps(motion);
  const double sigma_frames = kEvenOver_s / motion.frame_time_s;
  Vec3 moved = Vec3::Zero();
  for (int t = 0; t < motion.num_frames(); ++t) {
    moved += evened(steps, t, sigma_frames);
    motion.root_positions[static_cast<std::size_t>(t)] += moved;
  }
}

}  // namespace sparse_mocap::eom2014
