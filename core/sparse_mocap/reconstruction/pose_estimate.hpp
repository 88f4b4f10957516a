// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/motion/extremities.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// What a method says of a frame beside the pose, by name; the unit is part of the name. Methods
// that retrieve from a database give
//   sensor_misfit_mps2  a sensor: retrieved against measured specific force; NaN while it is silent
//   specific_force_mps2  a sensor, x y z: what it measured, low-passed
//   spread_m            a joint: weighted deviation of the retrieved positions
//   clip, database_frame  the ones that the pose is closest to
using Diagnostics = std::map<std::string, Eigen::VectorXd, std::less<>>;

// What retrieved frames say of feet, toes and hands, in the order of extremity::Index.
struct ExtremityVote {
  std::array<Quat, kNumExtremities> R_parent_joint;
  std::array<double, kNumExtremities> certainty{};  // the share of the frames that know it, 0 to 1

  ExtremityVote() { R_parent_joint.fill(Quat::Identity()); }
};

// One reconstructed frame of a method's skeleton.
struct PoseEstimate {
  double time_s = 0.0;                // of the reading that it belongs to
  std::vector<Quat> rotations;        // R_parent_joint of every joint; the root's is R_world_root
  Vec3 root_position = Vec3::Zero();  // m, world
  Eigen::Vector2d contacts = Eigen::Vector2d::Zero();  // probability that left, right foot stand
  Diagnostics diagnostics;
  ExtremityVote extremities{};  // what the method says of them, if its skeleton lacks them
};

// The estimates as a motion in the world.
Motion to_motion(const std::vector<PoseEstimate>& estimates, const Skeleton& skeleton,
                 double rate_hz);

}  // namespace sparse_mocap
