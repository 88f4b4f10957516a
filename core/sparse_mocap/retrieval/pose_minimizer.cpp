// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/pose_minimizer.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sparse_mocap::retrieval {
namespace {

constexpr double kRelativeDecrease = 1e-7;  // below this share of the value, it has converged
constexpr int kMaxHalvings = 12;

PoseVector best_start(const PoseObjective& objective, const PoseSubspace& subspace,
                      std::span<const PoseVector> starts) {
  if (starts.empty()) throw std::invalid_argument("minimize: at least one start is needed");
  PoseVector best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& start : starts) {
    const PoseVector coordinates = subspace.coordinates(start);
    if (starts.size() == 1) return coordinates;
    const double value = objective.value(subspace.pose(coordinates));
    if (value >= lowest) continue;
    lowest = value;
    best = coordinates;
  }
  return best;
}

// The minimiser of the model, a little regularised so that flat directions stay where they are.
PoseVector model_step(const PoseObjective::Model& model) {
  PoseMatrix h = model.hessian;
  h.diagonal().array() += 1e-9 * (1.0 + h.diagonal().maxCoeff());
  PoseVector step = -model.gradient;
  h.ldlt().solveInPlace(step);
  return step;
}

}  // namespace

Minimum minimize(const PoseObjective& objective, const PoseSubspace& subspace,
                 std::span<const PoseVector> starts, int max_iterations) {
  PoseVector y = best_start(objective, subspace, starts);
  Minimum minimum;
  PoseObjective::Model model = objective.majorised(subspace.pose(y), subspace.basis);
  while (minimum.iterations < max_iterations && !minimum.is_converged) {
    ++minimum.iterations;
    PoseVector step = model_step(model);
    const double promised = -0.5 * model.gradient.dot(step);
    const double negligible = kRelativeDecrease * std::abs(model.value);
    double value = objective.value(subspace.pose(y + step));
    for (int halving = 0; value > model.value && halving < kMaxHalvings; ++halving) {
      step *= 0.5;
      value = objective.value(subspace.pose(y + step));
    }
    if (value > model.value) {
      minimum.is_converged = promised <= negligible;
      break;
    }
    minimum.is_converged = model.value - value <= negligible;
    y += step;
    model = objective.majorised(subspace.pose(y), subspace.basis);
  }
  minimum.angles = subspace.pose(y);
  minimum.value = model.value;
  return minimum;
}

}  // namespace sparse_mocap::retrieval
