// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/control.hpp"

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::tautges2011 {

void put_heading_accelerations(const Reading& reading, const JointTransforms& pose,
                               std::span<const retrieval::Signal> signals, Eigen::Matrix3Xd& out) {
  out.resize(3, static_cast<Eigen::Index>(signals.size()));
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(signals[s].site)];
    const Mat3 R_heading_sensor =
        pose.R_world_joint[static_cast<std::size_t>(site.orientation)] * site.R_joint_sensor;
    out.col(static_cast<Eigen::Index>(s)) =
        R_heading_sensor * reading.specific_force.col(signals[s].sensor) - kGravity_mps2 * kUp;
  }
}

void put_control_term(const PathDerivatives& derivatives, const Config& config,
                      const Eigen::VectorXd& positions_now,
                      const Eigen::Matrix3Xd& accelerations_now,
                      std::span<const retrieval::Signal> signals, double dt_s, KernelTerm& term) {
  term.space.compared = TermSpace::Compared::positions;
  term.space.joints.clear();
  term.targets.resize(3 * static_cast<Eigen::Index>(signals.size()),
                      derivatives.velocities_before.cols());
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const Vec3 acceleration = accelerations_now.col(static_cast<Eigen::Index>(s));
    if (!acceleration.allFinite()) continue;
    const int joint = all_sites()[static_cast<std::size_t>(signals[s].site)].carrier;
    const Vec3 moved = positions_now.segment<3>(3 * joint) + 0.5 * acceleration * dt_s * dt_s;
    term.targets.middleRows(3 * static_cast<Eigen::Index>(term.space.joints.size()), 3) =
        (derivatives.velocities_before.middleRows(3 * joint, 3) * dt_s).colwise() + moved;
    term.space.joints.push_back(joint);
  }
  term.weight = term.space.joints.empty() ? 0.0 : config.w_contr;
}

}  // namespace sparse_mocap::tautges2011
