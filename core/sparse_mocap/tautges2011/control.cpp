// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/control.hpp"

#include <vector>

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::tautges2011 {

Eigen::Matrix3Xd heading_accelerations(const Reading& reading, const JointTransforms& pose,
                                       std::span<const retrieval::Signal> signals) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(signals.size()));
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(signals[s].site)];
    const Mat3 R_heading_sensor =
        pose.R_world_joint[static_cast<std::size_t>(site.orientation)] * site.R_joint_sensor;
    out.col(static_cast<Eigen::Index>(s)) =
        R_heading_sensor * reading.specific_force.col(signals[s].sensor) - kGravity_mps2 * kUp;
  }
  return out;
}

KernelTerm control_term(const PathDerivatives& derivatives, const Config& config,
                        const Eigen::VectorXd& positions_now,
                        const Eigen::Matrix3Xd& accelerations_now,
                        std::span<const retrieval::Signal> signals, double dt_s) {
  KernelTerm term{{}, config.w_contr, {}};
  std::vector<Eigen::Index> delivering;
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const auto column = static_cast<Eigen::Index>(s);
    if (!accelerations_now.col(column).allFinite()) continue;
    delivering.push_back(column);
    term.space.joints.push_back(all_sites()[static_cast<std::size_t>(signals[s].site)].carrier);
  }
  if (delivering.empty()) term.weight = 0.0;
  term.targets.resize(3 * static_cast<Eigen::Index>(delivering.size()),
                      derivatives.velocities_before.cols());
  for (std::size_t k = 0; k < delivering.size(); ++k) {
    const Eigen::Index row = 3 * term.space.joints[k];
    const Vec3 moved =
        positions_now.segment<3>(row) + 0.5 * accelerations_now.col(delivering[k]) * dt_s * dt_s;
    term.targets.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        (derivatives.velocities_before.middleRows(row, 3) * dt_s).colwise() + moved;
  }
  return term;
}

}  // namespace sparse_mocap::tautges2011
