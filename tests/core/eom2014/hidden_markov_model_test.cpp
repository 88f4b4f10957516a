// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/hidden_markov_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random.hpp"

namespace sparse_mocap::eom2014 {
namespace {

using sparse_mocap::testing::Random;

Eigen::MatrixXd probabilities(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd out(rows, columns);
  for (auto& value : out.reshaped()) value = random.in(0.1, 1.0);
  for (Eigen::Index r = 0; r < rows; ++r) out.row(r) /= out.row(r).sum();
  return out;
}

Symbols random_symbols(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Symbols out(rows, columns);
  for (auto& symbol : out.reshaped()) symbol = random.below(3);
  return out;
}

// What every way through the states adds up to.
struct Enumerated {
  double likelihood = 0.0;
  Eigen::MatrixXd states, transitions;

  Enumerated(const HiddenMarkovModel& model, const Symbols& symbols)
      : states(Eigen::MatrixXd::Zero(symbols.rows(), model.num_states())),
        transitions(Eigen::MatrixXd::Zero(model.num_states(), model.num_states())) {
    std::vector<int> way;
    visit(model, symbols, 1.0 / model.num_states(), way);
    states /= likelihood;
    transitions /= likelihood;
  }

  void visit(const HiddenMarkovModel& model, const Symbols& symbols, double probability,
             std::vector<int>& way) {
    const auto t = static_cast<Eigen::Index>(way.size());
    if (t == symbols.rows()) {
      likelihood += probability;
      for (std::size_t i = 0; i < way.size(); ++i) {
        states(static_cast<Eigen::Index>(i), way[i]) += probability;
        if (i > 0) transitions(way[i - 1], way[i]) += probability;
      }
      return;
    }
    for (int s = 0; s < model.num_states(); ++s) {
      double next = probability * (t == 0 ? 1.0 : model.transition(way.back(), s));
      for (Eigen::Index c = 0; c < symbols.cols(); ++c)
        next *= model.emission[static_cast<std::size_t>(c)](s, symbols(t, c));
      way.push_back(s);
      visit(model, symbols, next, way);
      way.pop_back();
    }
  }
};

TEST(EomHiddenMarkovModel, ForwardAndBackwardAgreeWithEveryWayThroughTheStates) {
  Random random(7);
  const HiddenMarkovModel model{probabilities(random, 3, 3),
                                {probabilities(random, 3, 3), probabilities(random, 3, 3)}};
  const Symbols symbols = random_symbols(random, 6, 2);
  const Enumerated expected(model, symbols);
  const StatePosterior found = forward_backward(model, symbols);
  EXPECT_NEAR(found.log_likelihood, std::log(expected.likelihood), 1e-10);
  EXPECT_NEAR(model.log_likelihood(symbols), std::log(expected.likelihood), 1e-10);
  EXPECT_LT((found.states - expected.states).norm(), 1e-10);
  EXPECT_LT((found.transitions - expected.transitions).norm(), 1e-10);
}

TEST(EomHiddenMarkovModel, LearningDoesNotLowerTheLikelihood) {
  Random random(8);
  std::vector<Symbols> sequences;
  for (int i = 0; i < 5; ++i) sequences.push_back(random_symbols(random, 12, 2));
  HmmSettings settings;
  settings.smoothing = 1e-6;
  double last = -1e300;
  for (const int iterations : {0, 1, 2, 5, 20}) {
    settings.num_iterations = iterations;
    const HiddenMarkovModel model = trained(sequences, settings);
    double total = 0.0;
    for (const auto& symbols : sequences) total += model.log_likelihood(symbols);
    EXPECT_GE(total, last - 1e-6) << iterations;
    last = total;
  }
}

TEST(EomHiddenMarkovModel, GoesFromLeftToRightAndKnowsWhatItWasTrainedOn) {
  Symbols rising(9, 1), falling(9, 1);
  rising << 0, 0, 0, 1, 1, 1, 2, 2, 2;
  falling << 2, 2, 2, 1, 1, 1, 0, 0, 0;
  const HiddenMarkovModel model = trained({rising, rising}, HmmSettings());
  EXPECT_EQ(model.transition(1, 0), 0.0);
  EXPECT_EQ(model.transition(0, 2), 0.0);
  EXPECT_GT(model.log_likelihood(rising), model.log_likelihood(falling) + 5.0);
}

}  // namespace
}  // namespace sparse_mocap::eom2014
