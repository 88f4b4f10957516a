// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparse_mocap::retrieval {

// Finds the rows that may be among the k nearest to a query, in many dimensions, where the cells of
// a kd-tree keep hardly any row out. Rows are turned onto their principal axes, so that few
// dimensions carry most of a distance, and sorted into blocks of near rows. A query looks at those
// blocks alone whose bounding box is near enough, at a few dimensions first.
class BlockScan {
 public:
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // Of the rows of `features` that are listed, which must be finite. The features are copied.
  BlockScan(const Rows& features, std::span<const std::uint32_t> listed);

  // Places in the list of a few more rows than the k nearest (k <= the length of the list): all
  // whose distance, in exact arithmetic or rounded as floats are, is not above the k-th smallest.
  void near_rows(std::span<const float> query, std::size_t k,
                 std::vector<std::uint32_t>& places) const;

 private:
  static constexpr std::size_t kBlock = 64;  // rows

  struct Query;
  std::vector<std::uint32_t> block_order(const Rows& turned) const;
  void fill_blocks(const Rows& turned, const std::vector<std::uint32_t>& order);
  void fill_sample(const Rows& turned);
  float sampled_bound(const Query& query, std::size_t k) const;
  bool scan(const Query& query, std::size_t k, float bound,
            std::vector<std::uint32_t>& places) const;

  std::size_t num_rows_ = 0, num_dimensions_ = 0, num_blocks_ = 0, num_sampled_ = 0;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd R_feature_axes_;     // columns: principal axes, the most varied first
  double largest_norm_ = 0.0;          // of the turned rows
  std::vector<float> blocks_;          // [block][dimension][row of the block]
  std::vector<std::uint32_t> places_;  // of the blocks' rows in the list
  std::vector<float> low_, high_;      // [dimension][block]: the blocks' boxes
  std::vector<float> sample_;          // [dimension][sampled row]
};

}  // namespace sparse_mocap::retrieval
