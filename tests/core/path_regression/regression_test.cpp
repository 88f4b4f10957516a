// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "support/random.hpp"

namespace sparse_mocap::path_regression {
namespace {

using testing::Random;

// Features x I, a query near them, weights and a quantity to predict.
struct Problem {
  Eigen::MatrixXd features;
  Eigen::VectorXd query, weights, values;
};

Problem random_problem(Random& random, Eigen::Index dimensions, Eigen::Index count) {
  Problem problem{random.matrix(dimensions, count, 5.0), random.column(dimensions, 5.0),
                  random.column(count, 1.0).array().abs() + 0.01, random.column(count, 2.0)};
  problem.weights /= problem.weights.sum();
  problem.values += problem.features.transpose() * random.column(dimensions, 0.5);
  return problem;
}

// Slopes by least squares on stacked rows: the weighted data, and the ridge as data of its own.
double predicted(const Problem& problem, double ridge) {
  const auto dimensions = problem.features.rows(), count = problem.features.cols();
  const Eigen::VectorXd mean = problem.features * problem.weights;
  const double mean_value = problem.values.dot(problem.weights);
  const Eigen::MatrixXd centred = problem.features.colwise() - mean;
  const double variance =
      (centred.cwiseAbs2() * problem.weights).sum() / static_cast<double>(dimensions);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count + dimensions, dimensions);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count + dimensions);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double root = std::sqrt(problem.weights[i]);
    rows.row(i) = root * centred.col(i).transpose();
    right[i] = root * (problem.values[i] - mean_value);
  }
  for (Eigen::Index d = 0; d < dimensions; ++d) rows(count + d, d) = std::sqrt(ridge * variance);
  const Eigen::VectorXd slopes = rows.colPivHouseholderQr().solve(right);
  return mean_value + slopes.dot(problem.query - mean);
}

Eigen::VectorXd found_weights(const Problem& problem, double ridge) {
  return regression_weights(problem.features.cast<float>(), problem.query.cast<float>(),
                            problem.weights, ridge);
}

TEST(RegressionWeights, PredictAsRidgeRegressionDoes) {
  Random random(1);
  for (const double ridge : {0.01, 1.0, 6.0, 100.0}) {
    for (const auto& [dimensions, count] : {std::pair{3, 40}, {12, 64}, {60, 30}}) {
      const Problem problem = random_problem(random, dimensions, count);
      const Eigen::VectorXd weights = found_weights(problem, ridge);
      EXPECT_NEAR(weights.dot(problem.values), predicted(problem, ridge), 2e-3)
          << ridge << " " << dimensions;
      EXPECT_NEAR(weights.sum(), 1.0, 1e-4);
    }
  }
}

TEST(RegressionWeights, ReturnTheLineThatTheDataLieOn) {
  Random random(2);
  Problem problem = random_problem(random, 4, 50);
  const Eigen::VectorXd slopes = random.column(4, 1.0);
  problem.values = (problem.features.transpose() * slopes).array() + 3.0;
  EXPECT_NEAR(found_weights(problem, 1e-6).dot(problem.values), slopes.dot(problem.query) + 3.0,
              1e-2);
}

TEST(RegressionWeights, AreThoseOfThePathsUnderAHeavyRidgeOrAtTheMean) {
  Random random(3);
  Problem problem = random_problem(random, 5, 30);
  EXPECT_LT((found_weights(problem, 1e8) - problem.weights).norm(), 1e-6);
  problem.query = problem.features * problem.weights;
  EXPECT_LT((found_weights(problem, 1.0) - problem.weights).norm(), 1e-5);
}

TEST(RegressionWeights, LeaveSilentDimensionsOut) {
  Random random(4);
  Problem problem = random_problem(random, 5, 30);
  Problem fewer = problem;
  fewer.features = problem.features.topRows(3).eval();
  fewer.query = problem.query.head(3).eval();
  problem.query.tail(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_LT((found_weights(problem, 2.0) - found_weights(fewer, 2.0)).norm(), 1e-6);
  problem.query.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(found_weights(problem, 2.0), problem.weights);
}

TEST(RegressionWeights, AreThoseOfThePathsWhenAllFeaturesAreAlike) {
  Random random(5);
  Problem problem = random_problem(random, 3, 10);
  problem.features.setConstant(2.0);
  EXPECT_LT((found_weights(problem, 1.0) - problem.weights).norm(), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
