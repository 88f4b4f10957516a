// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::liu2011 {

// An online local linear dynamic model (Liu et al. 2011, section 5): what a movement does next, as
// a linear function of what it just did, learnt from the K examples that are closest to it.
struct LocalDynamicModel {
  Eigen::VectorXd mean_x, mean_y;  // weighted means of the examples, which the paper takes for zero
  Eigen::MatrixXd axes;            // U_w: orthonormal columns
  Eigen::MatrixXd gamma;           // reduced coefficients, one column a degree of freedom
  Eigen::VectorXd deviations;      // sigma_d, of the residuals
  Eigen::MatrixXd residuals;       // times the roots of the examples' shares, one column each

  // Equation (8) without its noise: mean_y + beta_w^T (x - mean_x), where beta_w = U_w gamma.
  Eigen::VectorXd predicted(const Eigen::VectorXd& x) const {
    return mean_y + gamma.transpose() * (axes.transpose() * (x - mean_x));
  }
};

// Equations (2) to (8): locally weighted regression from histories (columns of x) to the poses that
// follow (columns of y) in the principal subspace that holds the share `variance` of the weighted
// variance of x. Weights are positive.
//
// The paper takes the synthesised history that is asked about for exact (trust 1), so that what is
// wrong in it stays. If it is instead off as examples differ, with 1 / trust - 1 times their
// covariance, a prediction is drawn to the mean: the coefficients are `trust` times those of the
// regression, and what the history no longer explains is in the residuals.
LocalDynamicModel local_dynamic_model(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                                      const Eigen::VectorXd& weights, double variance,
                                      double trust = 1.0);

// w_k of equation (6) for the distances of the examples, D being 1 / their median squared, since
// the paper's identity depends on units.
Eigen::VectorXd example_weights(const Eigen::VectorXd& distances);

// Eigenvectors of factor factor^T with their values, by falling value: as many as hold the share of
// its trace, at least one. Few of them are found by a Lanczos iteration.
struct LeadingPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
LeadingPairs leading_pairs(const Eigen::MatrixXd& factor, double share);

}  // namespace sparse_mocap::liu2011
