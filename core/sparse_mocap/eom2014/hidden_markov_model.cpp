// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/hidden_markov_model.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap::eom2014 {
namespace {

// Expected numbers of transitions and symbols.
struct Counts {
  Eigen::MatrixXd transition;
  std::vector<Eigen::MatrixXd> emission;

  Counts(Eigen::Index num_channels, const HmmSettings& settings) {
    transition.setZero(settings.num_states, settings.num_states);
    emission.assign(
        static_cast<std::size_t>(num_channels),
        Eigen::MatrixXd::Constant(settings.num_states, settings.num_symbols, settings.smoothing));
    for (int s = 0; s < settings.num_states; ++s) {
      transition(s, s) = settings.smoothing;
      if (s + 1 < settings.num_states) transition(s, s + 1) = settings.smoothing;
    }
  }

  void add(const Symbols& symbols, const Eigen::MatrixXd& states) {
    for (Eigen::Index t = 0; t < symbols.rows(); ++t)
      for (Eigen::Index c = 0; c < symbols.cols(); ++c)
        emission[static_cast<std::size_t>(c)].col(symbols(t, c)) += states.row(t).transpose();
  }

  HiddenMarkovModel model() const {
    HiddenMarkovModel out{transition, emission};
    const auto normalise = [](Eigen::MatrixXd& rows) {
      rows.array().colwise() /= rows.rowwise().sum().array();
    };
    normalise(out.transition);
    for (auto& channel : out.emission) normalise(channel);
    return out;
  }
};

// Each sequence evenly over the states.
HiddenMarkovModel evenly_split(const std::vector<Symbols>& sequences, const HmmSettings& settings) {
  Counts counts(sequences.front().cols(), settings);
  for (const auto& symbols : sequences) {
    Eigen::MatrixXd states = Eigen::MatrixXd::Zero(symbols.rows(), settings.num_states);
    const auto state_at = [&](Eigen::Index t) {
      return std::min<Eigen::Index>(t * settings.num_states / symbols.rows(),
                                    settings.num_states - 1);
    };
    for (Eigen::Index t = 0; t < symbols.rows(); ++t) {
      states(t, state_at(t)) = 1.0;
      if (t == 0) continue;
      const Eigen::Index to = std::min(state_at(t), state_at(t - 1) + 1);
      counts.transition(state_at(t - 1), to) += 1.0;
    }
    counts.add(symbols, states);
  }
  return counts.model();
}

}  // namespace

Eigen::VectorXd HiddenMarkovModel::emitted(
    const Eigen::Ref<const Eigen::RowVectorXi>& symbols) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(num_states());
  for (Eigen::Index c = 0; c < symbols.size(); ++c)
    out = out.cwiseProduct(emission[static_cast<std::size_t>(c)].col(symbols[c]));
  return out;
}

double HiddenMarkovModel::log_likelihood(const Symbols& symbols) const {
  Eigen::VectorXd forward = Eigen::VectorXd::Constant(num_states(), 1.0 / num_states());
  double value = 0.0;
  for (Eigen::Index t = 0; t < symbols.rows(); ++t) {
    if (t > 0) forward = transition.transpose() * forward;
    forward = forward.cwiseProduct(emitted(symbols.row(t)));
    const double scale = forward.sum();
    value += std::log(scale);
    forward /= scale;
  }
  return value;
}

StatePosterior forward_backward(const HiddenMarkovModel& model, const Symbols& symbols) {
  const Eigen::Index n = symbols.rows(), num_states = model.num_states();
  Eigen::MatrixXd emitted(num_states, n), forward(num_states, n), backward(num_states, n);
  Eigen::VectorXd scale(n);
  StatePosterior out;
  for (Eigen::Index t = 0; t < n; ++t) {
    emitted.col(t) = model.emitted(symbols.row(t));
    const Eigen::VectorXd before =
        t == 0 ? Eigen::VectorXd::Constant(num_states, 1.0 / static_cast<double>(num_states)).eval()
               : (model.transition.transpose() * forward.col(t - 1)).eval();
    forward.col(t) = before.cwiseProduct(emitted.col(t));
    scale[t] = forward.col(t).sum();
    forward.col(t) /= scale[t];
    out.log_likelihood += std::log(scale[t]);
  }
  out.transitions.setZero(num_states, num_states);
  backward.col(n - 1).setOnes();
  for (Eigen::Index t = n - 1; t > 0; --t) {
    const Eigen::VectorXd ahead = emitted.col(t).cwiseProduct(backward.col(t)) / scale[t];
    backward.col(t - 1) = model.transition * ahead;
    out.transitions += (forward.col(t - 1) * ahead.transpose()).cwiseProduct(model.transition);
  }
  out.states = forward.cwiseProduct(backward).transpose();
  return out;
}

HiddenMarkovModel trained(const std::vector<Symbols>& all, const HmmSettings& settings) {
  std::vector<Symbols> sequences;
  std::copy_if(all.begin(), all.end(), std::back_inserter(sequences),
               [](const Symbols& symbols) { return symbols.rows() > 0; });
  HiddenMarkovModel model = evenly_split(sequences, settings);
  for (int i = 0; i < settings.num_iterations; ++i) {
    Counts counts(sequences.front().cols(), settings);
    for (const auto& symbols : sequences) {
      const StatePosterior posterior = forward_backward(model, symbols);
      counts.transition += posterior.transitions;
      counts.add(symbols, posterior.states);
    }
    model = counts.model();
  }
  return model;
}

}  // namespace sparse_mocap::eom2014
