// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/base/progress.hpp"

namespace sparse_mocap::eom2014 {

// A multilayer perceptron with one hidden layer of hyperbolic tangents:
//   y = W2 tanh(W1 x + b1) + b2.
struct Perceptron {
  Eigen::MatrixXd W1, W2;
  Eigen::VectorXd b1, b2;

  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const {
    return W2 * (W1 * x + b1).array().tanh().matrix() + b2;
  }
};

struct PerceptronSettings {
  int num_hidden = 20;
  double weight_decay = 0.1;
  int max_iterations = 150;
  unsigned seed = 1;  // of the weights at the start
};

// 1/2 sum |f(x_i) - y_i|^2 + decay/2 (|W1|^2 + |W2|^2) over rows x_i, y_i; gradient, unless null,
// gets what it changes with the weights.
double perceptron_cost(const Perceptron& perceptron, const Eigen::MatrixXd& inputs,
                       const Eigen::MatrixXd& outputs, double weight_decay, Perceptron* gradient);

// Learns from rows of inputs and outputs, both of a size near 1, by L-BFGS. Throws Cancelled.
Perceptron trained(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                   const PerceptronSettings& settings, const Progress& progress);

}  // namespace sparse_mocap::eom2014
