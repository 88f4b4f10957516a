// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/root_motion.hpp"

#include <algorithm>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::retrieval {

RootRates root_rates(const MotionDatabase& database, const WeightedPaths& weighted) {
  Eigen::Vector4d motion = Eigen::Vector4d::Zero();
  RootRates rates;
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const int frame = weighted.paths[i].frame;
    const double weight = weighted.weights[static_cast<Eigen::Index>(i)];
    motion += weight * database.root_motion().row(frame).transpose().cast<double>();
    rates.contacts += weight * database.contacts().row(frame).transpose().cast<double>();
  }
  rates.contacts = rates.contacts.cwiseMin(1.0);  // weights sum to 1 but for rounding
  rates.velocity_mps = {motion[root_motion_column::velocity_left],
                        motion[root_motion_column::velocity_forward]};
  rates.yaw_rate_radps = motion[root_motion_column::yaw_rate];
  rates.height_m = motion[root_motion_column::height];
  return rates;
}

// The root's horizontal velocity at which the standing feet stay where they are, by how surely they
// stand; certainty is that of the surer foot.
Eigen::Vector2d RootTracker::standing_velocity(const RootRates& rates,
                                               const Eigen::VectorXd& positions,
                                               double& certainty) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0.0;
  certainty = 0.0;
  const Mat3 R_before_now = yaw_rotation(rates.yaw_rate_radps * dt_s_);
  for (const auto& [side, ankle] :
       {std::pair<Eigen::Index, Eigen::Index>{0, standard_joint::ltibia},
        std::pair<Eigen::Index, Eigen::Index>{1, standard_joint::rtibia}}) {
    const double stands = rates.contacts[side];
    const Vec3 moved =
        R_before_now * positions.segment<3>(3 * ankle) - positions_before_.segment<3>(3 * ankle);
    sum -= stands * stands * Eigen::Vector2d(moved.x(), moved.z()) / dt_s_;
    total += stands * stands;
    certainty = std::max(certainty, stands);
  }
  if (total <= 0.0) return rates.velocity_mps;
  return sum / total;
}

void RootTracker::advance(const RootRates& rates, const Eigen::VectorXd& positions) {
  position_.y() = rates.height_m;
  if (positions_before_.size() > 0) {
    double certainty = 0.0;
    const Eigen::Vector2d standing = standing_velocity(rates, positions, certainty);
    const double lock = foot_lock_ * certainty;
    const Eigen::Vector2d velocity = (1.0 - lock) * rates.velocity_mps + lock * standing;
    position_ += yaw_rotation(yaw_rad_) * Vec3(velocity.x(), 0.0, velocity.y()) * dt_s_;
    yaw_rad_ += rates.yaw_rate_radps * dt_s_;
  }
  positions_before_ = positions;
}

}  // namespace sparse_mocap::retrieval
