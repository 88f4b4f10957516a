// SPDX-License-Identifier: GPL-3.0-or-later
//
// The energy as a sum of squares, minimised by Ceres' Levenberg-Marquardt: what a solver for least
// squares, such as the paper's, makes of it.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "sparse_mocap/retrieval/subspace.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::testing {

// A residual for each path and kernel term: sqrt(2 weight w_i) |y_i - y|^(1/4), whose square is
// twice what the term adds to the energy.
class KernelResiduals : public ceres::CostFunction {
 public:
  KernelResiduals(const Skeleton& skeleton, const Eigen::VectorXd& weights,
                  const std::vector<tautges2011::KernelTerm>& kernels,
                  const retrieval::PoseSubspace& subspace)
      : skeleton_(skeleton), weights_(weights), kernels_(kernels), subspace_(subspace) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(subspace.basis.cols()));
    set_num_residuals(static_cast<int>(weights.size()) * static_cast<int>(kernels.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const auto n = subspace_.basis.cols(), num_paths = weights_.size();
    const Eigen::VectorXd angles =
        subspace_.pose(Eigen::Map<const Eigen::VectorXd>(parameters[0], n));
    JointTransforms pose;
    forward_kinematics(skeleton_, Vec3::Zero(), angles, pose);
    const Eigen::MatrixXd slopes = position_jacobian(skeleton_, angles, pose) * subspace_.basis;
    for (std::size_t k = 0; k < kernels_.size(); ++k) {
      const auto& kernel = kernels_[k];
      const Eigen::VectorXd y = observed(kernel.space, angles, pose);
      const Eigen::MatrixXd dy = observed_slopes(kernel.space, slopes);
      for (Eigen::Index i = 0; i < num_paths; ++i) {
        const Eigen::VectorXd off = y - kernel.targets.col(i);
        const double softening = tautges2011::Energy::kSoftening;
        const double square = off.squaredNorm() + softening * softening;
        const double scale = std::sqrt(2.0 * kernel.weight * weights_[i]);
        const Eigen::Index row = static_cast<Eigen::Index>(k) * num_paths + i;
        residuals[row] = scale * std::pow(square, 0.125);
        if (jacobians == nullptr || jacobians[0] == nullptr) continue;
        Eigen::Map<Eigen::RowVectorXd>(jacobians[0] + row * n, n) =
            0.25 * scale * std::pow(square, -0.875) * off.transpose() * dy;
      }
    }
    return true;
  }

 private:
  static bool compares_angles(const tautges2011::TermSpace& space) {
    return space.compared == tautges2011::TermSpace::Compared::angles;
  }
  std::vector<int> joints_of(const tautges2011::TermSpace& space) const {
    std::vector<int> joints = space.joints;
    for (int j = 0; space.joints.empty() && j < skeleton_.num_joints(); ++j) joints.push_back(j);
    return joints;
  }
  Eigen::VectorXd observed(const tautges2011::TermSpace& space, const Eigen::VectorXd& angles,
                           const JointTransforms& pose) const {
    if (compares_angles(space)) return angles;
    const auto joints = joints_of(space);
    Eigen::VectorXd y(3 * static_cast<Eigen::Index>(joints.size()));
    for (std::size_t j = 0; j < joints.size(); ++j)
      y.segment<3>(3 * static_cast<Eigen::Index>(j)) =
          pose.end[static_cast<std::size_t>(joints[j])];
    return y;
  }
  Eigen::MatrixXd observed_slopes(const tautges2011::TermSpace& space,
                                  const Eigen::MatrixXd& slopes) const {
    if (compares_angles(space)) return subspace_.basis;
    const auto joints = joints_of(space);
    Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(joints.size()), slopes.cols());
    for (std::size_t j = 0; j < joints.size(); ++j)
      rows.middleRows(3 * static_cast<Eigen::Index>(j), 3) = slopes.middleRows(3 * joints[j], 3);
    return rows;
  }

  const Skeleton& skeleton_;
  const Eigen::VectorXd& weights_;
  const std::vector<tautges2011::KernelTerm>& kernels_;
  const retrieval::PoseSubspace& subspace_;
};

// The least energy that Levenberg-Marquardt reaches from the start. Of kernel terms alone.
inline double least_squares_minimum(const Skeleton& skeleton, const Eigen::VectorXd& weights,
                                    const std::vector<tautges2011::KernelTerm>& kernels,
                                    const retrieval::PoseSubspace& subspace,
                                    const Eigen::VectorXd& start) {
  ceres::Problem problem;
  Eigen::VectorXd coordinates = subspace.coordinates(start);
  problem.AddResidualBlock(new KernelResiduals(skeleton, weights, kernels, subspace), nullptr,
                           coordinates.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.final_cost;
}

}  // namespace sparse_mocap::testing
