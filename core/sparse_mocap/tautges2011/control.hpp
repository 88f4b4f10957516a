// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/reconstruction/method.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"
#include "sparse_mocap/tautges2011/neighbourhood.hpp"

namespace sparse_mocap::tautges2011 {

// What the sensors accelerate by in the heading frame (m/s^2, gravity removed; 3 x sensors, NaN
// where silent, and for other quantities), their local frames taken from the pose: alpha-hat of
// equation (10).
Eigen::Matrix3Xd heading_accelerations(const Reading& reading, const JointTransforms& pose,
                                       const std::vector<WornSensor>& sensors);

// E_contr, equations (10), (11): the joints next to the sensors, moved on from x^t by the retrieved
// velocities V^t and the measured acceleration. Silent sensors take no part.
KernelTerm control_term(const Neighbourhood& neighbours, const Config& config,
                        const Eigen::VectorXd& positions_now,
                        const Eigen::Matrix3Xd& accelerations_now,
                        const std::vector<WornSensor>& sensors, double dt_s);

}  // namespace sparse_mocap::tautges2011
