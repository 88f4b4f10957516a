// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {

// One channel of one sensor, as its samples come: vectors are low-passed and sampled at any time,
// rotations (4 rows, w x y z) are interpolated along the shorter arc between the two samples beside
// it.
//
// A channel is silent, and its value NaN, at times that lie in a gap of more than kLongestGap_s
// between samples. Before the first sample and after the last one, up to kLongestGap_s is no gap:
// sensors start and end a moment apart.
class Resampler {
 public:
  static constexpr double kLongestGap_s = 0.1;

  enum class Kind { vector, rotation };

  explicit Resampler(Kind kind) : kind_(kind) {}

  // A sample; dropped, with false, when it is not finite or not after the one before.
  bool push(double time_s, std::span<const double> value);

  // Whether there is a sample at this time or after it.
  bool reaches(double time_s) const;

  // What the samples so far say. has_ended: no more will come, so the last sample holds for a
  // moment; before that, what comes next is not known, and the value is NaN.
  Eigen::VectorXd at(double time_s, GaussianFilter filter, bool has_ended) const;

  // Forgets the samples before a time, but for the last of them.
  void forget(double before_s);

 private:
  Eigen::Index rows() const { return kind_ == Kind::rotation ? 4 : 3; }
  std::span<const double> times_s() const;
  Eigen::Map<const Eigen::MatrixXd> values() const;
  Eigen::VectorXd rotation_at(double time_s) const;

  Kind kind_;
  std::size_t begin_ = 0;  // samples before it are forgotten
  std::vector<double> times_s_;
  std::vector<double> values_;  // rows() a sample
};

}  // namespace sparse_mocap
