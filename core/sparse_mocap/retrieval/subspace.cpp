// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/subspace.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sparse_mocap::retrieval {
namespace {

// Its lower half, in pieces that Eigen multiplies without memory of the heap.
PoseMatrix weighted_covariance(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights,
                               const PoseVector& mean) {
  constexpr Eigen::Index kPiece = 128;  // poses
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostPoseValues, kPiece>
      rooted;
  PoseMatrix covariance = PoseMatrix::Zero(poses.rows(), poses.rows());
  for (Eigen::Index begin = 0; begin < poses.cols(); begin += kPiece) {
    const Eigen::Index count = std::min(kPiece, poses.cols() - begin);
    rooted = poses.middleCols(begin, count).colwise() - mean;
    for (Eigen::Index i = 0; i < count; ++i) rooted.col(i) *= std::sqrt(weights[begin + i]);
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(rooted);
  }
  return covariance;
}

}  // namespace

PoseSubspace weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights,
                          double variance) {
  PoseSubspace out;
  put_weighted_pca(poses, weights, variance, out);
  return out;
}

void put_weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights, double variance,
                      PoseSubspace& out) {
  out.mean.noalias() = poses * weights;
  const Eigen::SelfAdjointEigenSolver<PoseMatrix> eigen(
      weighted_covariance(poses, weights, out.mean));
  // Eigen sorts ascending.
  const PoseVector values = eigen.eigenvalues().cwiseMax(0.0).reverse();
  const double wanted = variance * values.sum();
  Eigen::Index components = 0;
  double kept = 0.0;
  while (components < values.size() && (components == 0 || kept < wanted))
    kept += values[components++];
  out.basis = eigen.eigenvectors().rowwise().reverse().leftCols(components);
}

}  // namespace sparse_mocap::retrieval
