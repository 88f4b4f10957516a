// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/perceptron.hpp"

#include <cmath>
#include <random>

#include "sparse_mocap/eom2014/minimisation.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kTolerance = 1e-6;

Eigen::VectorXd packed(const Perceptron& p) {
  Eigen::VectorXd out(p.W1.size() + p.W2.size() + p.b1.size() + p.b2.size());
  out << p.W1.reshaped(), p.W2.reshaped(), p.b1, p.b2;
  return out;
}

// Of the shapes that like has.
Perceptron unpacked(const Eigen::VectorXd& weights, const Perceptron& like) {
  Perceptron out = like;
  Eigen::Index at = 0;
  const auto take = [&](auto& values) {
    values = weights.segment(at, values.size()).reshaped(values.rows(), values.cols());
    at += values.size();
  };
  take(out.W1);
  take(out.W2);
  take(out.b1);
  take(out.b2);
  return out;
}

// std distributions differ from one library to another; the engine does not.
Perceptron random_start(Eigen::Index num_inputs, Eigen::Index num_outputs,
                        const PerceptronSettings& settings) {
  std::mt19937 engine(settings.seed);
  const auto filled = [&](Eigen::Index rows, Eigen::Index columns) {
    const double size = std::sqrt(3.0 / static_cast<double>(columns));
    Eigen::MatrixXd out(rows, columns);
    for (auto& value : out.reshaped())
      value = size * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1.0);
    return out;
  };
  return {filled(settings.num_hidden, num_inputs), filled(num_outputs, settings.num_hidden),
          Eigen::VectorXd::Zero(settings.num_hidden), Eigen::VectorXd::Zero(num_outputs)};
}

}  // namespace

double perceptron_cost(const Perceptron& p, const Eigen::MatrixXd& inputs,
                       const Eigen::MatrixXd& outputs, double weight_decay, Perceptron* gradient) {
  Eigen::MatrixXd hidden = inputs * p.W1.transpose();
  hidden.rowwise() += p.b1.transpose();
  hidden = hidden.array().tanh();
  Eigen::MatrixXd errors = hidden * p.W2.transpose() - outputs;
  errors.rowwise() += p.b2.transpose();
  if (gradient != nullptr) {
    const Eigen::MatrixXd by_hidden = (errors * p.W2).array() * (1.0 - hidden.array().square());
    gradient->W2 = errors.transpose() * hidden + weight_decay * p.W2;
    gradient->b2 = errors.colwise().sum();
    gradient->W1 = by_hidden.transpose() * inputs + weight_decay * p.W1;
    gradient->b1 = by_hidden.colwise().sum();
  }
  return 0.5 * errors.squaredNorm() +
         0.5 * weight_decay * (p.W1.squaredNorm() + p.W2.squaredNorm());
}

Perceptron trained(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                   const PerceptronSettings& settings, const Progress& progress) {
  const Perceptron start = random_start(inputs.cols(), outputs.cols(), settings);
  const Function cost = [&](const Eigen::VectorXd& weights, Eigen::VectorXd* gradient) {
    Perceptron by_weights;
    const double value =
        perceptron_cost(unpacked(weights, start), inputs, outputs, settings.weight_decay,
                        gradient == nullptr ? nullptr : &by_weights);
    if (gradient != nullptr) *gradient = packed(by_weights);
    return value;
  };
  return unpacked(minimum(cost, packed(start), settings.max_iterations, kTolerance, progress,
                          "learning the mapping"),
                  start);
}

}  // namespace sparse_mocap::eom2014
