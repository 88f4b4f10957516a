// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/banded_system.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace sparse_mocap::path_regression {

void BandedSystem::clear(int num_blocks, int block_size) {
  block_size_ = block_size;
  blocks_.resize(static_cast<std::size_t>(num_blocks) * (kReach + 1));
  right_.resize(static_cast<std::size_t>(num_blocks));
  for (auto& block : blocks_) block.setZero(block_size, block_size);
  for (auto& right : right_) right.setZero(block_size);
}

Eigen::MatrixXd& BandedSystem::block(int row, int column) {
  return blocks_[static_cast<std::size_t>(row * (kReach + 1) + row - column)];
}

void BandedSystem::damp(double damping) {
  for (int i = 0; i < num_blocks(); ++i) {
    auto diagonal = block(i, i).diagonal();
    diagonal.array() += damping * diagonal.array() + 1e-9;
  }
}

bool BandedSystem::decompose(const std::function<void(int)>& reached) {
  constexpr int kReportedEach = 32;
  for (int i = 0; i < num_blocks(); ++i) {
    if (reached && i % kReportedEach == 0) reached(i);
    for (int j = std::max(0, i - kReach); j < i; ++j) {
      Eigen::MatrixXd& L = block(i, j);
      for (int k = std::max(0, i - kReach); k < j; ++k)
        L.noalias() -= block(i, k) * block(j, k).transpose();
      block(j, j).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(L);
    }
    Eigen::MatrixXd& diagonal = block(i, i);
    for (int k = std::max(0, i - kReach); k < i; ++k)
      diagonal.selfadjointView<Eigen::Lower>().rankUpdate(block(i, k), -1.0);
    Eigen::Ref<Eigen::MatrixXd> in_place(diagonal);
    if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(in_place).info() != Eigen::Success) return false;
  }
  return true;
}

bool BandedSystem::solve(Eigen::MatrixXd& unknowns, const std::function<void(int)>& reached) {
  if (!decompose(reached)) return false;
  const int n = num_blocks();
  unknowns.resize(block_size_, n);
  for (int i = 0; i < n; ++i) {
    auto y = unknowns.col(i);
    y = right(i);
    for (int k = std::max(0, i - kReach); k < i; ++k) y.noalias() -= block(i, k) * unknowns.col(k);
    block(i, i).triangularView<Eigen::Lower>().solveInPlace(y);
  }
  for (int i = n; i-- > 0;) {
    auto x = unknowns.col(i);
    for (int k = i + 1; k <= std::min(n - 1, i + kReach); ++k)
      x.noalias() -= block(k, i).transpose() * unknowns.col(k);
    block(i, i).triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  }
  return true;
}

}  // namespace sparse_mocap::path_regression
