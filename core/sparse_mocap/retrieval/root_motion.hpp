// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"

namespace sparse_mocap::retrieval {

// What the neighbours say about the root (Tautges et al. 2011, section 6.4): weighted means.
struct RootRates {
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();  // left, forward; heading frame
  double yaw_rate_radps = 0.0;
  double height_m = 0.0;                               // above the floor
  Eigen::Vector2d contacts = Eigen::Vector2d::Zero();  // share of neighbours that stand
};

RootRates root_rates(const MotionDatabase& database, const WeightedPaths& weighted);

// Follows the root through a performance that starts at the origin, facing forward.
//
// foot_lock (0 to 1) is how far a foot that stands for certain overrules the neighbours' mean
// velocity: the root then moves so that the foot stays.
class RootTracker {
 public:
  RootTracker(double dt_s, double foot_lock) : dt_s_(dt_s), foot_lock_(foot_lock) {}

  void reset() { *this = RootTracker(dt_s_, foot_lock_); }
  // positions: the new pose's joint ends, heading frame, stacked.
  void advance(const RootRates& rates, const Eigen::VectorXd& positions);

  const Vec3& position() const { return position_; }
  double yaw_rad() const { return yaw_rad_; }

 private:
  Eigen::Vector2d standing_velocity(const RootRates& rates, const Eigen::VectorXd& positions,
                                    double& certainty) const;

  double dt_s_;
  double foot_lock_;
  Vec3 position_ = Vec3::Zero();
  double yaw_rad_ = 0.0;
  Eigen::VectorXd positions_before_;
};

}  // namespace sparse_mocap::retrieval
