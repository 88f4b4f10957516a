// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/frame_path.hpp"

#include <array>

#include "sparse_mocap/eom2014/readings.hpp"

namespace sparse_mocap::eom2014 {
namespace {

// The probabilities that the performer stays in a frame, or goes one or two frames on.
constexpr std::array kSteps{0.2, 0.5, 0.25};

// Where each training frame's sequence ends.
std::vector<Eigen::Index> ends_of(const std::vector<int>& begins, Eigen::Index num_frames) {
  std::vector<Eigen::Index> ends;
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const Eigen::Index end = s + 1 < begins.size() ? begins[s + 1] : num_frames;
    ends.insert(ends.end(), static_cast<std::size_t>(end - begins[s]), end);
  }
  return ends;
}

// The probability to arrive at each frame, given those before; what neither stays nor goes on may
// go anywhere.
Eigen::VectorXd gone_on(const Eigen::VectorXd& before, const std::vector<Eigen::Index>& ends) {
  const Eigen::Index n = before.size();
  Eigen::VectorXd after = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (std::size_t by = 0; by < kSteps.size(); ++by) {
      const Eigen::Index to = i + static_cast<Eigen::Index>(by);
      if (to < ends[static_cast<std::size_t>(i)]) after[to] += kSteps[by] * before[i];
    }
  after.array() += (before.sum() - after.sum()) / static_cast<double>(n);
  return after;
}

// The same against time: what is expected of each frame, given what is ahead.
Eigen::VectorXd come_from(const Eigen::VectorXd& ahead, const std::vector<Eigen::Index>& ends) {
  const Eigen::Index n = ahead.size();
  const double anywhere = ahead.mean();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    double rest = 1.0;
    for (std::size_t by = 0; by < kSteps.size(); ++by) {
      const Eigen::Index to = i + static_cast<Eigen::Index>(by);
      if (to >= ends[static_cast<std::size_t>(i)]) continue;
      before[i] += kSteps[by] * ahead[to];
      rest -= kSteps[by];
    }
    before[i] += rest * anywhere;
  }
  return before;
}

}  // namespace

Eigen::MatrixXd frame_posterior(const Eigen::MatrixXd& features, const Eigen::MatrixXd& training,
                                const std::vector<int>& begins, double width) {
  const Eigen::Index n = features.rows(), num_frames = training.rows();
  const auto ends = ends_of(begins, num_frames);
  Eigen::MatrixXd distances = squared_distances(training, features);
  // Relative to the nearest frame, so that readings unlike all of them still have likeliest ones.
  distances.rowwise() -= distances.colwise().minCoeff().eval();
  const Eigen::MatrixXd emitted = (-0.5 / (width * width) * distances.array()).exp();
  Eigen::MatrixXd forward(num_frames, n);
  for (Eigen::Index t = 0; t < n; ++t) {
    forward.col(t) = emitted.col(t);
    if (t > 0) forward.col(t).array() *= gone_on(forward.col(t - 1), ends).array();
    forward.col(t) /= forward.col(t).sum();
  }
  Eigen::VectorXd backward = Eigen::VectorXd::Ones(num_frames);
  for (Eigen::Index t = n - 2; t >= 0; --t) {
    backward = come_from(backward.cwiseProduct(emitted.col(t + 1)), ends);
    backward /= backward.sum();
    forward.col(t).array() *= backward.array();
    forward.col(t) /= forward.col(t).sum();
  }
  return forward.transpose();
}

}  // namespace sparse_mocap::eom2014
