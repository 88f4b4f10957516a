// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::path_regression {

// Local linear (ridge) regression as a re-weighting: for any quantity y_i of the neighbours, the
// value that regression on their features predicts at the query is sum_i out_i y_i.
//   out_i = w_i (1 + (f_i - f)^T (C + ridge s I)^-1 (query - f)), f and C the weighted mean and
//   covariance of the features, s their mean variance. Sums to 1; may be negative.
// features: dimensions x I. Dimensions where the query is NaN take no part.
Eigen::VectorXd regression_weights(const Eigen::MatrixXf& features, const Eigen::VectorXf& query,
                                   const Eigen::VectorXd& weights, double ridge);
void put_regression_weights(const Eigen::MatrixXf& features, const Eigen::VectorXf& query,
                            const Eigen::VectorXd& weights, double ridge, Eigen::VectorXd& out);

}  // namespace sparse_mocap::path_regression
