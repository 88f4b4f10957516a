// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace sparse_mocap::path_regression {

// A symmetric, positive definite system of linear equations in which a block of unknowns meets only
// blocks at most kReach before or after it, as frames of a take do. Solved by block Cholesky
// decomposition, linear in the number of blocks.
class BandedSystem {
 public:
  static constexpr int kReach = 2;

  BandedSystem(int num_blocks, int block_size) { clear(num_blocks, block_size); }

  // All zero; of the same size in the same memory.
  void clear(int num_blocks, int block_size);

  int num_blocks() const { return static_cast<int>(right_.size()); }
  int block_size() const { return block_size_; }
  // Only the lower triangle is kept: column <= row <= column + kReach.
  Eigen::MatrixXd& block(int row, int column);
  Eigen::VectorXd& right(int row) { return right_[static_cast<std::size_t>(row)]; }

  // Adds to every diagonal entry: damping times itself, and a little more.
  void damp(double damping);
  // The unknowns, one column a block; decomposes in place, so that it can be called once. False
  // where the system is not positive definite. reached(i) is called at some blocks on the way; what
  // it throws ends the work.
  bool solve(Eigen::MatrixXd& unknowns, const std::function<void(int)>& reached = {});

 private:
  bool decompose(const std::function<void(int)>& reached);

  int block_size_ = 0;
  std::vector<Eigen::MatrixXd> blocks_;
  std::vector<Eigen::VectorXd> right_;
};

}  // namespace sparse_mocap::path_regression
