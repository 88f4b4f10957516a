// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace sparse_mocap::eom2014 {

// One row an instant, one column a channel; each a symbol from 0 on.
using Symbols = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A hidden Markov model of several channels of symbols, which are independent given the state. It
// may begin in any state, and then goes from left to right: it stays or goes to the next one.
struct HiddenMarkovModel {
  Eigen::MatrixXd transition;             // states x states, rows sum to 1
  std::vector<Eigen::MatrixXd> emission;  // of each channel: states x symbols, rows sum to 1

  int num_states() const { return static_cast<int>(transition.rows()); }

  // The probability of a row of symbols in each state.
  Eigen::VectorXd emitted(const Eigen::Ref<const Eigen::RowVectorXi>& symbols) const;
  // ln P(symbols | model).
  double log_likelihood(const Symbols& symbols) const;
};

struct HmmSettings {
  int num_states = 3;
  int num_symbols = 3;
  int num_iterations = 30;
  double smoothing = 0.5;  // what is added to each count, so that nothing is impossible
};

// Learns by Baum and Welch from sequences of one channel number, at least one of them not empty; it
// begins with each sequence split evenly over the states.
HiddenMarkovModel trained(const std::vector<Symbols>& sequences, const HmmSettings& settings);

// What is known of the states of a sequence.
struct StatePosterior {
  Eigen::MatrixXd states;       // instants x states, rows sum to 1
  Eigen::MatrixXd transitions;  // states x states, expected numbers
  double log_likelihood = 0.0;
};
StatePosterior forward_backward(const HiddenMarkovModel& model, const Symbols& symbols);

}  // namespace sparse_mocap::eom2014
