// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

namespace sparse_mocap::retrieval {

using FeatureRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Neighbour {
  float distance = 0.0F;  // Euclidean
  int row = 0;

  auto operator<=>(const Neighbour&) const = default;
};

// Exact K-nearest-neighbour search over feature rows (Tautges et al. 2011, section 3): by a kd-tree
// in few dimensions, as the paper does, else by blocks (block_scan.hpp), whose answers are the
// same. Immutable: any number of threads may search at once.
class KnnIndex {
 public:
  // Searches only the rows for which is_searched is true (all when it is empty).
  KnnIndex(FeatureRows features, const std::vector<bool>& is_searched = {});
  ~KnnIndex();
  KnnIndex(KnnIndex&&) noexcept;
  KnnIndex& operator=(KnnIndex&&) noexcept;

  int num_rows() const;  // that are searched
  int num_dimensions() const;
  const FeatureRows& features() const;

  // The k rows (all, if fewer) nearest to query by (distance, row), in that order: of equally far
  // rows those with the smaller number win. Dimensions where query is NaN are left out of the
  // distance.
  void search(std::span<const float> query, int k, std::vector<Neighbour>& out) const;

 private:
  struct Searched;
  std::unique_ptr<Searched> searched_;
};

}  // namespace sparse_mocap::retrieval
