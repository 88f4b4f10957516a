// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sparse_mocap/retrieval/block_kernels.hpp"

namespace sparse_mocap::retrieval {

// Finds the rows that may be among the k nearest to a query, in many dimensions, where the cells of
// a kd-tree keep hardly any row out. Rows are sorted into blocks of near rows, and blocks into
// groups. A query looks at those groups and blocks alone whose bounding box is near enough: at
// values of eight bits each, in the dimensions that vary most first.
class BlockScan {
 public:
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // Of the rows of `features` that are listed, which must be finite. Does not depend on the number
  // of threads (0: one a processor).
  BlockScan(const Rows& features, std::span<const std::uint32_t> listed, int num_threads = 0);

  // Places in the list of a few more rows than the k nearest (k <= the length of the list): all
  // whose distance, in exact arithmetic or rounded as floats are, is not above the k-th smallest.
  // Dimensions where the query is NaN are left out of the distance.
  void near_rows(std::span<const float> query, std::size_t k,
                 std::vector<std::uint32_t>& places) const;

 private:
  struct Source;
  struct Query;
  struct Candidates;
  void order_dimensions(const Source& rows);
  void fill_blocks(const Source& rows);
  void fill_block(const Source& rows, std::size_t block);
  void fill_groups();
  void fill_sample(const Source& rows);
  CoarseBlock coarse_block(std::size_t block) const;
  float sampled_radius(const Query& query, std::size_t k) const;
  void scan(const Query& query, float radius, Candidates& found) const;
  void scan_group(const Query& query, float radius, std::size_t group, Candidates& found) const;
  void scan_block(const Query& query, float radius, std::size_t block, Candidates& found) const;

  std::size_t num_rows_ = 0, num_dimensions_ = 0, num_blocks_ = 0, num_groups_ = 0;
  std::size_t num_sampled_ = 0;
  std::vector<std::size_t> dimensions_;        // the most varied first
  float largest_norm_ = 0.0F;                  // of the rows
  std::vector<std::uint32_t> places_;          // of the blocks' rows in the list
  std::vector<std::uint8_t> codes_;            // [block][dimension][row of the block]
  std::vector<float> error_;                   // [block]: by how much its codes miss a row at most
  std::vector<float> low_, high_;              // [group][dimension][block of the group]: boxes
  std::vector<float> group_low_, group_high_;  // [dimension][group]
  std::vector<float> sample_;                  // [dimension][sampled row]
};

}  // namespace sparse_mocap::retrieval
