// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/root_motion.hpp"

#include "sparse_mocap/motion/heading.hpp"

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

void RootTracker::advance(const RootRates& rates) {
  position_.y() = rates.height_m;
  if (has_begun_) {
    const Vec3 velocity(rates.velocity_mps.x(), 0.0, rates.velocity_mps.y());
    position_ += yaw_rotation(yaw_rad_) * velocity * dt_s_;
    yaw_rad_ += rates.yaw_rate_radps * dt_s_;
  }
  has_begun_ = true;
}

}  // namespace sparse_mocap::retrieval
