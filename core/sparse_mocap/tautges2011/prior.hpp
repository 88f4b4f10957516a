// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/derivatives.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::tautges2011 {

// The three terms of E_prior (Tautges et al. 2011, section 5.1), weighted as equations (2) and (3)
// say. Positions are stacked joint ends in the heading frame, m.

// Each takes the place of the term that is given, in its memory.

// Equations (4), (5).
void put_pose_prior(const retrieval::Neighbourhood& neighbours, const Config& config,
                    KernelTerm& term);

// Equations (6), (7); positions_now is x^t.
void put_motion_prior(const PathDerivatives& derivatives, const Config& config,
                      const Eigen::VectorXd& positions_now, double dt_s, KernelTerm& term);

// Equations (8), (9). dt sqrt|a_i - a| is the kernel of positions at 2 x^t - x^(t-1) + a_i dt^2;
// positions_before is x^(t-1).
void put_smoothness_prior(const PathDerivatives& derivatives, const Config& config,
                          const Eigen::VectorXd& positions_now,
                          const Eigen::VectorXd& positions_before, double dt_s, KernelTerm& term);

}  // namespace sparse_mocap::tautges2011
