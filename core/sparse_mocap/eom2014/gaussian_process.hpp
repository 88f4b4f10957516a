// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::eom2014 {

// How likely the columns of Y are under a Gaussian process with kernel matrix K, each column scaled
// by its weight (Eom et al. 2014, equations 2 and 4):
//   -1/2 tr(K^-1 Y W^2 Y^T) - D/2 ln|K| + N ln|W|
// at the W that makes it largest, w_d = sqrt(N / (y_d^T K^-1 y_d)).
struct ScaledLikelihood {
  double value = 0.0;
  Eigen::MatrixXd by_kernel;  // N x N, d value / d K
  Eigen::VectorXd weights;    // D, the diagonal of W
};

// K is N x N and positive definite, Y N x D without a column of zeros. The value is minus infinity,
// and the rest empty, where K is not positive definite in numbers.
ScaledLikelihood scaled_likelihood(const Eigen::MatrixXd& K, const Eigen::MatrixXd& Y);

}  // namespace sparse_mocap::eom2014
