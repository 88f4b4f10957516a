// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/gaussian_process.hpp"

#include <Eigen/Cholesky>
#include <limits>

namespace sparse_mocap::eom2014 {

ScaledLikelihood scaled_likelihood(const Eigen::MatrixXd& K, const Eigen::MatrixXd& Y) {
  ScaledLikelihood out;
  const Eigen::LLT<Eigen::MatrixXd> factor(K);
  if (factor.info() != Eigen::Success) {
    out.value = -std::numeric_limits<double>::infinity();
    return out;
  }
  const auto num_rows = static_cast<double>(Y.rows());
  const auto num_columns = static_cast<double>(Y.cols());
  const Eigen::MatrixXd K_inverse =
      factor.solve(Eigen::MatrixXd::Identity(Y.rows(), Y.rows()).eval());
  Eigen::MatrixXd scaled = K_inverse * Y;
  out.weights =
      (num_rows / Y.cwiseProduct(scaled).colwise().sum().array()).sqrt().matrix().transpose();
  scaled = scaled * out.weights.asDiagonal();
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  out.value = -0.5 * num_rows * num_columns - 0.5 * num_columns * log_determinant +
              num_rows * out.weights.array().log().sum();
  out.by_kernel = -0.5 * num_columns * K_inverse;
  out.by_kernel.noalias() += 0.5 * scaled * scaled.transpose();
  return out;
}

}  // namespace sparse_mocap::eom2014
