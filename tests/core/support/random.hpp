// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap::testing {

// The same sequence on every machine: std distributions may differ, so none is used.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  int below(int limit) { return static_cast<int>(engine_() % static_cast<unsigned>(limit)); }
  Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Eigen::VectorXd column(Eigen::Index n, double size) {
    Eigen::VectorXd out(n);
    for (auto& value : out) value = in(-size, size);
    return out;
  }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns, double size) {
    Eigen::MatrixXd out(rows, columns);
    for (auto& value : out.reshaped()) value = in(-size, size);
    return out;
  }
  Quat rotation() { return Quat(in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1) + 1e-3).normalized(); }

 private:
  std::mt19937 engine_;
};

}  // namespace sparse_mocap::testing
