// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/local_dynamic_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sparse_mocap::liu2011 {
namespace {

constexpr double kSmallestShare = 1e-8;  // of the largest eigenvalue; smaller ones are rounding
constexpr double kConverged = 1e-7;      // error of an eigenvector, as a share of the largest value
constexpr double kFewPairsShare = 0.95;  // beyond it, all pairs are sought at once
constexpr Eigen::Index kFirstSteps = 8, kMoreSteps = 4, kMostSteps = 80;

// How many of the values, which fall, hold so much of the trace.
Eigen::Index num_wanted(const Eigen::VectorXd& values, double wanted) {
  Eigen::Index count = 1;
  double held = values[0];
  while (count < values.size() && held < wanted && values[count] > kSmallestShare * values[0])
    held += values[count++];
  return count;
}

LeadingPairs all_pairs(const Eigen::MatrixXd& factor, double wanted) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(factor * factor.transpose());
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0.0).reverse();  // were ascending
  const Eigen::Index count = num_wanted(values, wanted);
  return {values.head(count), eigen.eigenvectors().rowwise().reverse().leftCols(count)};
}

// The Ritz pairs of a Krylov space; nothing while those wanted have not converged.
LeadingPairs ritz_pairs(const Eigen::MatrixXd& basis, const Eigen::VectorXd& diagonal,
                        const Eigen::VectorXd& beside, Eigen::Index steps, double wanted) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal.head(steps), beside.head(steps - 1));
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0.0).reverse();
  const Eigen::MatrixXd vectors = eigen.eigenvectors().rowwise().reverse();
  const double end = beside[steps - 1];  // 0: the space holds all there is
  const Eigen::Index count = num_wanted(values, wanted);
  const double error = end * vectors.row(steps - 1).head(count).cwiseAbs().maxCoeff();
  const bool holds_enough = values.head(count).sum() >= wanted || end == 0.0;
  if (!holds_enough || error > kConverged * values[0]) return {};
  return {values.head(count), basis.leftCols(steps) * vectors.leftCols(count)};
}

}  // namespace

LeadingPairs leading_pairs(const Eigen::MatrixXd& factor, double share) {
  const double wanted = share * factor.squaredNorm();
  const Eigen::Index size = factor.rows();
  const Eigen::Index most = std::min({kMostSteps, size, factor.cols()});
  if (share > kFewPairsShare || most < kFirstSteps || !(wanted > 0.0))
    return all_pairs(factor, wanted);
  Eigen::Index first = 0;
  factor.colwise().squaredNorm().maxCoeff(&first);
  Eigen::MatrixXd basis(size, most);
  Eigen::VectorXd diagonal(most), beside(most);
  Eigen::VectorXd next = factor.col(first).normalized();
  for (Eigen::Index step = 0; step < most; ++step) {
    basis.col(step) = next;
    next = factor * (factor.transpose() * basis.col(step));
    diagonal[step] = next.dot(basis.col(step));
    const auto known = basis.leftCols(step + 1);
    for (int pass = 0; pass < 2; ++pass) next -= known * (known.transpose() * next);
    beside[step] = next.norm();
    const bool has_ended = beside[step] <= kSmallestShare * diagonal[0];
    if (has_ended) beside[step] = 0.0;
    const bool is_due = step + 1 >= kFirstSteps && (step + 1 - kFirstSteps) % kMoreSteps == 0;
    if (has_ended || is_due) {
      LeadingPairs pairs = ritz_pairs(basis, diagonal, beside, step + 1, wanted);
      if (pairs.values.size() > 0) return pairs;
      if (has_ended) break;
    }
    next /= beside[step];
  }
  return all_pairs(factor, wanted);
}

LocalDynamicModel local_dynamic_model(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                                      const Eigen::VectorXd& weights, double variance,
                                      double trust) {
  const Eigen::VectorXd share = weights / weights.sum();
  const Eigen::VectorXd root = share.cwiseSqrt();
  LocalDynamicModel model;
  model.mean_x = x * share;
  model.mean_y = y * share;
  const Eigen::MatrixXd rooted_x = (x.colwise() - model.mean_x) * root.asDiagonal();
  const Eigen::MatrixXd rooted_y = (y.colwise() - model.mean_y) * root.asDiagonal();
  const LeadingPairs pairs = leading_pairs(rooted_x, variance);
  const Eigen::VectorXd inverse =
      (pairs.values.array() > 0.0).select(pairs.values.array().inverse(), 0.0);
  model.axes = pairs.vectors;
  // Equation (7): gamma = Lambda_w^-1 U_w^T X^T W y.
  const Eigen::MatrixXd scores = model.axes.transpose() * rooted_x;
  model.gamma = inverse.asDiagonal() * (scores * rooted_y.transpose());
  // Residuals of the regression are orthogonal to what it explains, so that the covariance of these
  // is that of residuals plus 1 - trust times that of what is explained.
  model.residuals = rooted_y - (1.0 - std::sqrt(1.0 - trust)) * model.gamma.transpose() * scores;
  model.gamma *= trust;
  model.deviations = model.residuals.rowwise().norm();
  return model;
}

Eigen::VectorXd example_weights(const Eigen::VectorXd& distances) {
  std::vector<double> sorted(distances.begin(), distances.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = std::max(*middle, 1e-9);
  return (-0.5 * (distances / median).array().square()).exp();
}

}  // namespace sparse_mocap::liu2011
