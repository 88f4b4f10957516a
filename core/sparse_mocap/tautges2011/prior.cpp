// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/prior.hpp"

namespace sparse_mocap::tautges2011 {

KernelTerm pose_prior(const Neighbourhood& neighbours, const Config& config) {
  const bool is_angles = config.pose_space == PoseSpace::angles;
  return {{is_angles ? Compared::angles : Compared::positions, {}},
          config.w_prior * config.w_pose,
          config.kernel_power,
          is_angles ? neighbours.angles : neighbours.positions};
}

KernelTerm motion_prior(const Neighbourhood& neighbours, const Config& config,
                        const Eigen::VectorXd& positions_now, double dt_s) {
  Eigen::MatrixXd displacement = neighbours.steps;
  if (config.motion_rule == MotionRule::taylor)
    displacement = neighbours.velocities * dt_s + 0.5 * neighbours.accelerations * dt_s * dt_s;
  return {{},
          config.w_prior * config.w_motion,
          config.kernel_power,
          displacement.colwise() + positions_now};
}

KernelTerm smoothness_prior(const Neighbourhood& neighbours, const Config& config,
                            const Eigen::VectorXd& positions_now,
                            const Eigen::VectorXd& positions_before, double dt_s) {
  const Eigen::VectorXd inertial = 2.0 * positions_now - positions_before;
  const Eigen::MatrixXd bend = neighbours.accelerations * dt_s * dt_s;
  return {{}, config.w_prior * config.w_smooth, config.kernel_power, bend.colwise() + inertial};
}

}  // namespace sparse_mocap::tautges2011
