// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/tautges2011/energy.hpp"
#include "sparse_mocap/tautges2011/subspace.hpp"

namespace sparse_mocap::tautges2011 {

struct Minimum {
  Eigen::VectorXd angles;  // rad, in the subspace
  double energy = 0.0;
  int iterations = 0;
  bool is_converged = false;  // false: out of iterations, or no shorter step went down
};

// The pose of least energy in the subspace (equation (2), section 5.3), by majorise-minimise: each
// step minimises the quadratic that touches the energy from above, halved until the energy falls.
// Descends from the best of the starts (poses, projected into the subspace; at least one).
Minimum minimize(const Energy& energy, const PoseSubspace& subspace,
                 const std::vector<Eigen::VectorXd>& starts, int max_iterations);

}  // namespace sparse_mocap::tautges2011
