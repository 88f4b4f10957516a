// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "sparse_mocap/retrieval/subspace.hpp"

namespace sparse_mocap::retrieval {

// What a pose is to minimise.
class PoseObjective {
 public:
  virtual ~PoseObjective() = default;

  // A quadratic in the pose, restricted to the columns of a basis (angles = ... + basis * d):
  // model(d) = value + gradient.d + d.hessian.d / 2.
  struct Model {
    double value = 0.0;
    PoseVector gradient;
    PoseMatrix hessian;
  };

  virtual double value(const PoseVector& angles) const = 0;
  // The model that touches the objective at angles and lies above it, for every fixed linearisation
  // of the joints' positions.
  virtual Model majorised(const PoseVector& angles, const PoseMatrix& basis) const = 0;
};

struct Minimum {
  PoseVector angles;  // rad, in the subspace
  double value = 0.0;
  int iterations = 0;
  bool is_converged = false;  // false: out of iterations, or no shorter step went down
};

// The pose of least value in the subspace, by majorise-minimise: each step minimises the model and
// is halved until the value falls. Descends from the best of the starts (poses, projected into the
// subspace; at least one).
Minimum minimize(const PoseObjective& objective, const PoseSubspace& subspace,
                 std::span<const PoseVector> starts, int max_iterations);

}  // namespace sparse_mocap::retrieval
