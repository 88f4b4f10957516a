// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/prior.hpp"

namespace sparse_mocap::tautges2011 {

KernelTerm pose_prior(const retrieval::Neighbourhood& neighbours, const Config& config) {
  return {{TermSpace::Compared::angles, {}}, config.w_prior * config.w_pose, neighbours.angles};
}

KernelTerm motion_prior(const PathDerivatives& derivatives, const Config& config,
                        const Eigen::VectorXd& positions_now, double dt_s) {
  const Eigen::MatrixXd displacement =
      derivatives.velocities * dt_s + 0.5 * derivatives.accelerations * dt_s * dt_s;
  return {{}, config.w_prior * config.w_motion, displacement.colwise() + positions_now};
}

KernelTerm smoothness_prior(const PathDerivatives& derivatives, const Config& config,
                            const Eigen::VectorXd& positions_now,
                            const Eigen::VectorXd& positions_before, double dt_s) {
  const Eigen::VectorXd inertial = 2.0 * positions_now - positions_before;
  const Eigen::MatrixXd bend = derivatives.accelerations * dt_s * dt_s;
  return {{}, config.w_prior * config.w_smooth, bend.colwise() + inertial};
}

}  // namespace sparse_mocap::tautges2011
