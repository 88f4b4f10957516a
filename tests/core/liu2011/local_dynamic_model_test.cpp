// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/local_dynamic_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "support/random.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::Random;

// Columns that vary mostly in a few directions, as poses do.
Eigen::MatrixXd examples_like(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd factors = random.matrix(12, columns, 1.0);
  for (Eigen::Index i = 0; i < 12; ++i) factors.row(i) *= 1.0 / static_cast<double>(1 + i);
  return random.matrix(rows, 12, 1.0) * factors + random.matrix(rows, columns, 0.01);
}

Eigen::VectorXd random_weights(Random& random, Eigen::Index count) {
  return (random.column(count, 1.0).array() + 1.2).matrix();
}

// Weighted least squares with an intercept, by QR: nothing is centred, no axes are found.
Eigen::VectorXd least_squares_prediction(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                                         const Eigen::VectorXd& weights,
                                         const Eigen::VectorXd& at) {
  const Eigen::VectorXd root = weights.cwiseSqrt();
  Eigen::MatrixXd design(x.cols(), x.rows() + 1);
  design << Eigen::VectorXd::Ones(x.cols()), x.transpose();
  const Eigen::MatrixXd coefficients =
      (root.asDiagonal() * design)
          .colPivHouseholderQr()
          .solve(root.asDiagonal() * Eigen::MatrixXd(y.transpose()));
  Eigen::VectorXd row(x.rows() + 1);
  row << 1.0, at;
  return coefficients.transpose() * row;
}

TEST(LocalDynamicModel, IsWeightedLeastSquaresOnAllComponents) {
  Random random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::MatrixXd x = random.matrix(15, 60, 1.0);
    const Eigen::MatrixXd y = random.matrix(7, 60, 1.0);
    const Eigen::VectorXd weights = random_weights(random, 60);
    const LocalDynamicModel model = local_dynamic_model(x, y, weights, 1.0);
    const Eigen::VectorXd at = random.column(15, 1.0);
    EXPECT_LT((model.predicted(at) - least_squares_prediction(x, y, weights, at)).norm(), 1e-8);
  }
}

TEST(LocalDynamicModel, IsWeightedLeastSquaresOnThePrincipalComponents) {
  Random random(2);
  const Eigen::MatrixXd x = examples_like(random, 40, 90);
  const Eigen::MatrixXd y = random.matrix(5, 90, 1.0);
  const Eigen::VectorXd weights = random_weights(random, 90);
  const LocalDynamicModel model = local_dynamic_model(x, y, weights, 0.8);
  const Eigen::Index count = model.axes.cols();
  EXPECT_GT(count, 1);
  EXPECT_LT(count, 12);
  EXPECT_LT((model.axes.transpose() * model.axes - Eigen::MatrixXd::Identity(count, count)).norm(),
            1e-8);
  const Eigen::VectorXd at = x.col(3);
  const Eigen::MatrixXd scores = model.axes.transpose() * x;
  EXPECT_LT((model.predicted(at) -
             least_squares_prediction(scores, y, weights, model.axes.transpose() * at))
                .norm(),
            1e-8);
}

TEST(LocalDynamicModel, PredictsALinearMovementWithoutDeviation) {
  Random random(3);
  const Eigen::MatrixXd x = random.matrix(6, 40, 1.0), map = random.matrix(4, 6, 1.0);
  const Eigen::VectorXd offset = random.column(4, 1.0);
  const Eigen::MatrixXd y = (map * x).colwise() + offset;
  const LocalDynamicModel model = local_dynamic_model(x, y, Eigen::VectorXd::Ones(40), 1.0);
  const Eigen::VectorXd at = random.column(6, 2.0);
  EXPECT_LT((model.predicted(at) - map * at - offset).norm(), 1e-9);
  EXPECT_LT(model.deviations.maxCoeff(), 1e-9);
}

TEST(LocalDynamicModel, StatesTheWeightedDeviationOfItsResiduals) {
  Random random(4);
  const Eigen::MatrixXd x = random.matrix(5, 50, 1.0), y = random.matrix(3, 50, 1.0);
  const Eigen::VectorXd weights = random_weights(random, 50);
  const LocalDynamicModel model = local_dynamic_model(x, y, weights, 0.7);
  for (Eigen::Index d = 0; d < 3; ++d) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < 50; ++k) {
      const double residual = y(d, k) - model.predicted(x.col(k))[d];
      sum += weights[k] * residual * residual;
    }
    EXPECT_NEAR(model.deviations[d], std::sqrt(sum / weights.sum()), 1e-9);
  }
}

// Examples as a normal distribution of histories and poses, and a history that is off: conditioned
// in the usual way, without axes or regression.
TEST(LocalDynamicModel, DoubtsTheHistoryAsANormalDistributionDoes) {
  Random random(6);
  const Eigen::MatrixXd x = random.matrix(8, 70, 1.0);
  const Eigen::MatrixXd y = random.matrix(5, 8, 1.0) * x + random.matrix(5, 70, 0.4);
  const Eigen::VectorXd weights = random_weights(random, 70), at = random.column(8, 1.0);
  const Eigen::VectorXd share = weights / weights.sum();
  const Eigen::MatrixXd dx = x.colwise() - x * share, dy = y.colwise() - y * share;
  const auto covariance = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return Eigen::MatrixXd(a * share.asDiagonal() * b.transpose());
  };
  for (const double trust : {0.25, 0.7, 1.0}) {
    const LocalDynamicModel model = local_dynamic_model(x, y, weights, 1.0, trust);
    const Eigen::MatrixXd seen = covariance(dx, dx) * (1.0 + (1.0 / trust - 1.0));
    const Eigen::MatrixXd gain = seen.ldlt().solve(Eigen::MatrixXd(covariance(dx, dy))).transpose();
    const Eigen::VectorXd expected = y * share + gain * (at - x * share);
    const Eigen::MatrixXd left = covariance(dy, dy) - gain * covariance(dx, dy);
    EXPECT_LT((model.predicted(at) - expected).norm(), 1e-9);
    EXPECT_LT((model.residuals * model.residuals.transpose() - left).norm(), 1e-9);
    EXPECT_LT((model.deviations - left.diagonal().cwiseSqrt()).norm(), 1e-9);
  }
}

TEST(LocalDynamicModel, OfEqualExamplesPredictsThem) {
  const Eigen::MatrixXd x = Eigen::MatrixXd::Constant(6, 9, 0.5);
  const Eigen::MatrixXd y = Eigen::MatrixXd::Constant(2, 9, -0.25);
  const LocalDynamicModel model = local_dynamic_model(x, y, Eigen::VectorXd::Ones(9), 0.8);
  EXPECT_LT((model.predicted(x.col(0)) - y.col(0)).norm(), 1e-9);
  EXPECT_LT(model.deviations.maxCoeff(), 1e-9);
}

TEST(LeadingPairs, AreThoseOfAWholeDecomposition) {
  Random random(5);
  for (const auto& [rows, columns] : {std::pair{120, 90}, {90, 120}, {30, 200}}) {
    const Eigen::MatrixXd factor = examples_like(random, rows, columns);
    const Eigen::MatrixXd matrix = factor * factor.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> whole(matrix);
    for (const double share : {0.3, 0.8, 0.94, 0.999}) {
      const LeadingPairs pairs = leading_pairs(factor, share);
      const Eigen::Index count = pairs.values.size();
      const Eigen::VectorXd values = whole.eigenvalues().reverse();
      EXPECT_GE(pairs.values.sum(), (share - 1e-9) * matrix.trace());
      EXPECT_LT(values.head(count - 1).sum(), share * matrix.trace());
      EXPECT_LT((pairs.values - values.head(count)).norm(), 1e-6 * values[0]);
      EXPECT_LT((matrix * pairs.vectors - pairs.vectors * pairs.values.asDiagonal()).norm(),
                1e-5 * values[0]);
    }
  }
}

TEST(ExampleWeights, FallAsEquation6Says) {
  const Eigen::VectorXd weights =
      example_weights((Eigen::VectorXd(5) << 0.0, 1.0, 2.0, 4.0, 8.0).finished());
  EXPECT_EQ(weights[0], 1.0);
  EXPECT_NEAR(weights[1], std::exp(-0.125), 1e-12);
  EXPECT_NEAR(weights[2], std::exp(-0.5), 1e-12);  // the median
  EXPECT_NEAR(weights[4], std::exp(-8.0), 1e-12);
  EXPECT_TRUE(example_weights(Eigen::VectorXd::Zero(3)).isApprox(Eigen::VectorXd::Ones(3)));
}

}  // namespace
}  // namespace sparse_mocap::liu2011
