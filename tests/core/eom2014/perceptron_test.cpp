// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/perceptron.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.hpp"

namespace sparse_mocap::eom2014 {
namespace {

using sparse_mocap::testing::Random;

TEST(EomPerceptron, GradientIsItsNumericalOne) {
  Random random(4);
  const Perceptron perceptron{random.matrix(3, 4, 1.0), random.matrix(2, 3, 1.0),
                              random.column(3, 1.0), random.column(2, 1.0)};
  const Eigen::MatrixXd inputs = random.matrix(7, 4, 1.0), outputs = random.matrix(7, 2, 1.0);
  Perceptron gradient;
  perceptron_cost(perceptron, inputs, outputs, 0.3, &gradient);
  constexpr double kStep = 1e-6;
  const auto check = [&](auto member) {
    for (Eigen::Index i = 0; i < (perceptron.*member).size(); ++i) {
      Perceptron more = perceptron, less = perceptron;
      (more.*member).reshaped()[i] += kStep;
      (less.*member).reshaped()[i] -= kStep;
      const double numerical = (perceptron_cost(more, inputs, outputs, 0.3, nullptr) -
                                perceptron_cost(less, inputs, outputs, 0.3, nullptr)) /
                               (2.0 * kStep);
      EXPECT_NEAR((gradient.*member).reshaped()[i], numerical, 1e-6) << i;
    }
  };
  check(&Perceptron::W1);
  check(&Perceptron::W2);
  check(&Perceptron::b1);
  check(&Perceptron::b2);
}

TEST(EomPerceptron, LearnsWhatIsNotLinear) {
  Random random(6);
  const Eigen::MatrixXd inputs = random.matrix(200, 2, 1.0);
  const Eigen::MatrixXd outputs =
      (3.0 * inputs.col(0).array()).sin() + inputs.col(1).array().square();
  PerceptronSettings settings;
  settings.weight_decay = 1e-4;
  settings.max_iterations = 2000;
  const Perceptron learnt = trained(inputs, outputs, settings, Progress());
  double largest = 0.0;
  for (Eigen::Index i = 0; i < inputs.rows(); ++i)
    largest = std::max(largest, std::abs(learnt(inputs.row(i))[0] - outputs(i, 0)));
  EXPECT_LT(largest, 0.15);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
