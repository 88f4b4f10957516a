// SPDX-License-Identifier: GPL-3.0-or-later
//
// The energy minimised by Ceres' L-BFGS: what our own minimiser is measured by.
#pragma once

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "sparse_mocap/retrieval/subspace.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::testing {

class EnergyInSubspace : public ceres::FirstOrderFunction {
 public:
  EnergyInSubspace(const tautges2011::Energy& energy, const retrieval::PoseSubspace& subspace)
      : energy_(energy), subspace_(subspace) {}

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const auto n = subspace_.basis.cols();
    const Eigen::VectorXd angles = subspace_.pose(Eigen::Map<const Eigen::VectorXd>(parameters, n));
    if (gradient == nullptr) {
      *cost = energy_.value(angles);
      return true;
    }
    Eigen::VectorXd by_angles;
    *cost = energy_.value_and_gradient(angles, by_angles);
    Eigen::Map<Eigen::VectorXd>(gradient, n) = subspace_.basis.transpose() * by_angles;
    return true;
  }
  int NumParameters() const override { return static_cast<int>(subspace_.basis.cols()); }

 private:
  const tautges2011::Energy& energy_;
  const retrieval::PoseSubspace& subspace_;
};

// The least energy that L-BFGS reaches from the start.
inline double ceres_minimum(const tautges2011::Energy& energy,
                            const retrieval::PoseSubspace& subspace, const Eigen::VectorXd& start) {
  const ceres::GradientProblem problem(new EnergyInSubspace(energy, subspace));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.line_search_type = ceres::WOLFE;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  Eigen::VectorXd coordinates = subspace.coordinates(start);
  ceres::Solve(options, problem, coordinates.data(), &summary);
  return summary.final_cost;
}

}  // namespace sparse_mocap::testing
