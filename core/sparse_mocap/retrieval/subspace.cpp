// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/subspace.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace sparse_mocap::retrieval {

PoseSubspace weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights,
                          double variance) {
  PoseSubspace out;
  out.mean = poses * weights;
  const Eigen::MatrixXd centred = poses.colwise() - out.mean;
  const Eigen::MatrixXd rooted = centred * weights.cwiseSqrt().asDiagonal();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(poses.rows(), poses.rows());
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(rooted);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  // Eigen sorts ascending.
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0.0).reverse();
  const double wanted = variance * values.sum();
  Eigen::Index components = 0;
  double kept = 0.0;
  while (components < values.size() && (components == 0 || kept < wanted))
    kept += values[components++];
  out.basis = eigen.eigenvectors().rowwise().reverse().leftCols(components);
  return out;
}

}  // namespace sparse_mocap::retrieval
