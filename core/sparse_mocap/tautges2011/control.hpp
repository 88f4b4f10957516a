// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/derivatives.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::tautges2011 {

// The sensors' linear accelerations in the heading frame (m/s^2, 3 x signals; NaN while a sensor is
// silent), their local frames taken from the pose: alpha-hat of equation (10).
void put_heading_accelerations(const Reading& reading, const JointTransforms& pose,
                               std::span<const retrieval::Signal> signals,
                               Eigen::Matrix3Xd& accelerations);

// E_contr, equations (10), (11): the joints next to the sensors, moved on from x^t by the retrieved
// velocities V^t and the measured acceleration. Silent sensors take no part. Takes the place of the
// term that is given, in its memory.
void put_control_term(const PathDerivatives& derivatives, const Config& config,
                      const Eigen::VectorXd& positions_now,
                      const Eigen::Matrix3Xd& accelerations_now,
                      std::span<const retrieval::Signal> signals, double dt_s, KernelTerm& term);

}  // namespace sparse_mocap::tautges2011
