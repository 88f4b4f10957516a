// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/kernels.hpp"

namespace sparse_mocap::eom2014 {
namespace {

Eigen::MatrixXd squared_distances(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out = -2.0 * a * b.transpose();
  out.colwise() += a.rowwise().squaredNorm();
  out.rowwise() += b.rowwise().squaredNorm().transpose();
  return out.cwiseMax(0.0);
}

// What sum_ij M_ij |p_i - p_j|^2 changes with the points; M is symmetric.
Eigen::MatrixXd by_points(const Eigen::MatrixXd& M, const Eigen::MatrixXd& points) {
  const Eigen::VectorXd sums = M.rowwise().sum();
  return 4.0 * (sums.asDiagonal() * points - M * points);
}

}  // namespace

Eigen::MatrixXd PoseKernel::between(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  return alpha[0] * (-0.5 * alpha[1] * squared_distances(a, b)).array().exp().matrix();
}

Eigen::MatrixXd PoseKernel::matrix(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd K = between(X, X);
  K.diagonal().array() += alpha[2];
  return K;
}

PoseKernel::Gradient PoseKernel::pulled_back(const Eigen::MatrixXd& X,
                                             const Eigen::MatrixXd& by_kernel) const {
  const Eigen::MatrixXd distances = squared_distances(X, X);
  const Eigen::MatrixXd weighted =
      by_kernel.array() * alpha[0] * (-0.5 * alpha[1] * distances.array()).exp();
  Gradient out;
  out.alpha = {weighted.sum() / alpha[0], -0.5 * weighted.cwiseProduct(distances).sum(),
               by_kernel.trace()};
  out.X = -0.5 * alpha[1] * by_points(weighted, X);
  return out;
}

Eigen::MatrixXd VelocityKernel::between(const Points& a, const Points& b) const {
  return beta[0] * (a.V * b.V.transpose()).array() *
         (-0.5 * beta[1] * squared_distances(a.V, b.V).array() -
          0.5 * beta[2] * squared_distances(a.X, b.X).array())
             .exp();
}

Eigen::MatrixXd VelocityKernel::matrix(const Points& points) const {
  Eigen::MatrixXd K = between(points, points);
  K.diagonal().array() += beta[3];
  return K;
}

VelocityKernel::Gradient VelocityKernel::pulled_back(const Points& points,
                                                     const Eigen::MatrixXd& by_kernel) const {
  const Eigen::MatrixXd of_steps = squared_distances(points.V, points.V);
  const Eigen::MatrixXd of_ends = squared_distances(points.X, points.X);
  const Eigen::MatrixXd nearness =
      by_kernel.array() * beta[0] *
      (-0.5 * beta[1] * of_steps.array() - 0.5 * beta[2] * of_ends.array()).exp();
  const Eigen::MatrixXd weighted = nearness.cwiseProduct(points.V * points.V.transpose());
  Gradient out;
  out.beta = {weighted.sum() / beta[0], -0.5 * weighted.cwiseProduct(of_steps).sum(),
              -0.5 * weighted.cwiseProduct(of_ends).sum(), by_kernel.trace()};
  out.V = 2.0 * nearness * points.V - 0.5 * beta[1] * by_points(weighted, points.V);
  out.X = -0.5 * beta[2] * by_points(weighted, points.X);
  return out;
}

}  // namespace sparse_mocap::eom2014
