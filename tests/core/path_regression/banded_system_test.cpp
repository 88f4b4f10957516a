// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/banded_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "support/random.hpp"

namespace sparse_mocap::path_regression {
namespace {

// A banded system and the same one as a full matrix.
struct Pair {
  BandedSystem banded;
  Eigen::MatrixXd dense;
  Eigen::VectorXd right;
};

// Sums of products of rows that meet three neighbouring blocks, as least squares has them.
Pair random_pair(testing::Random& random, int num_blocks, int size) {
  const Eigen::Index n = static_cast<Eigen::Index>(num_blocks) * size;
  Pair pair{BandedSystem(num_blocks, size), Eigen::MatrixXd::Identity(n, n) * 0.1,
            random.column(n, 1.0)};
  for (int b = 0; b < num_blocks; ++b) {
    const int first = std::max(0, b - BandedSystem::kReach);
    const Eigen::Index width = static_cast<Eigen::Index>(b - first + 1) * size;
    const Eigen::MatrixXd rows = random.matrix(3, width, 1.0);
    pair.dense.block(first * size, first * size, width, width) += rows.transpose() * rows;
  }
  for (int i = 0; i < num_blocks; ++i) {
    pair.banded.right(i) = pair.right.segment(i * size, size);
    for (int j = std::max(0, i - BandedSystem::kReach); j <= i; ++j)
      pair.banded.block(i, j) = pair.dense.block(i * size, j * size, size, size);
  }
  return pair;
}

TEST(BandedSystem, IsSolvedAsTheDenseSystemIs) {
  testing::Random random(1);
  for (const int num_blocks : {1, 2, 3, 4, 11}) {
    for (const int size : {1, 5}) {
      Pair pair = random_pair(random, num_blocks, size);
      Eigen::MatrixXd found;
      ASSERT_TRUE(pair.banded.solve(found));
      const Eigen::VectorXd expected = pair.dense.fullPivLu().solve(pair.right);
      EXPECT_LT((found.reshaped() - expected).norm(), 1e-9 * expected.norm())
          << num_blocks << " blocks of " << size;
    }
  }
}

TEST(BandedSystem, IsDampedOnItsDiagonal) {
  testing::Random random(2);
  Pair pair = random_pair(random, 4, 3);
  pair.banded.damp(0.5);
  pair.dense.diagonal().array() += 0.5 * pair.dense.diagonal().array() + 1e-9;
  Eigen::MatrixXd found;
  ASSERT_TRUE(pair.banded.solve(found));
  EXPECT_LT((pair.dense * found.reshaped() - pair.right).norm(), 1e-9);
}

TEST(BandedSystem, SaysWhenItIsNotPositiveDefinite) {
  testing::Random random(3);
  Pair pair = random_pair(random, 3, 2);
  pair.banded.block(1, 1)(0, 0) = -1.0;
  Eigen::MatrixXd found;
  EXPECT_FALSE(pair.banded.solve(found));
}

}  // namespace
}  // namespace sparse_mocap::path_regression
