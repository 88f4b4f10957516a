// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/control.hpp"

#include <limits>

#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::tautges2011 {

Eigen::Matrix3Xd heading_accelerations(const Reading& reading, const JointTransforms& pose,
                                       const std::vector<WornSensor>& sensors) {
  Eigen::Matrix3Xd out(3, reading.cols());
  out.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    if (sensors[s].quantity != Quantity::specific_force) continue;
    const Site& site = all_sites()[static_cast<std::size_t>(sensors[s].site)];
    const Mat3 R_heading_sensor =
        pose.R_world_joint[static_cast<std::size_t>(site.orientation)] * site.R_joint_sensor;
    const auto column = static_cast<Eigen::Index>(s);
    out.col(column) = R_heading_sensor * reading.col(column) - kGravity_mps2 * kUp;
  }
  return out;
}

KernelTerm control_term(const Neighbourhood& neighbours, const Config& config,
                        const Eigen::VectorXd& positions_now,
                        const Eigen::Matrix3Xd& accelerations_now,
                        const std::vector<WornSensor>& sensors, double dt_s) {
  KernelTerm term{{}, config.w_contr, config.kernel_power, {}};
  std::vector<Eigen::Index> sensor_columns;
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const auto column = static_cast<Eigen::Index>(s);
    if (!accelerations_now.col(column).allFinite()) continue;
    sensor_columns.push_back(column);
    term.space.joints.push_back(all_sites()[static_cast<std::size_t>(sensors[s].site)].carrier);
  }
  if (sensor_columns.empty()) term.weight = 0.0;
  term.targets.resize(3 * static_cast<Eigen::Index>(sensor_columns.size()),
                      neighbours.velocities_before.cols());
  for (std::size_t k = 0; k < sensor_columns.size(); ++k) {
    const Eigen::Index row = 3 * term.space.joints[k];
    const Vec3 moved = positions_now.segment<3>(row) +
                       0.5 * accelerations_now.col(sensor_columns[k]) * dt_s * dt_s;
    term.targets.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        (neighbours.velocities_before.middleRows(row, 3) * dt_s).colwise() + moved;
  }
  return term;
}

}  // namespace sparse_mocap::tautges2011
