// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/prior.hpp"

namespace sparse_mocap::tautges2011 {

void put_pose_prior(const retrieval::Neighbourhood& neighbours, const Config& config,
                    KernelTerm& term) {
  term.space.compared = TermSpace::Compared::angles;
  term.space.joints.clear();
  term.weight = config.w_prior * config.w_pose;
  term.targets = neighbours.angles;
}

void put_motion_prior(const PathDerivatives& derivatives, const Config& config,
                      const Eigen::VectorXd& positions_now, double dt_s, KernelTerm& term) {
  term.space.compared = TermSpace::Compared::positions;
  term.space.joints.clear();
  term.weight = config.w_prior * config.w_motion;
  term.targets = derivatives.velocities * dt_s + 0.5 * derivatives.accelerations * dt_s * dt_s;
  term.targets.colwise() += positions_now;
}

void put_smoothness_prior(const PathDerivatives& derivatives, const Config& config,
                          const Eigen::VectorXd& positions_now,
                          const Eigen::VectorXd& positions_before, double dt_s, KernelTerm& term) {
  term.space.compared = TermSpace::Compared::positions;
  term.space.joints.clear();
  term.weight = config.w_prior * config.w_smooth;
  term.targets = derivatives.accelerations * dt_s * dt_s;
  const retrieval::PoseVector inertial = 2.0 * positions_now - positions_before;
  term.targets.colwise() += inertial;
}

}  // namespace sparse_mocap::tautges2011
