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
class RootTracker {
 public:
  explicit RootTracker(double dt_s) : dt_s_(dt_s) {}

  void reset() { *this = RootTracker(dt_s_); }
  void advance(const RootRates& rates);

  const Vec3& position() const { return position_; }
  double yaw_rad() const { return yaw_rad_; }

 private:
  double dt_s_;
  Vec3 position_ = Vec3::Zero();
  double yaw_rad_ = 0.0;
  bool has_begun_ = false;
};

}  // namespace sparse_mocap::retrieval
