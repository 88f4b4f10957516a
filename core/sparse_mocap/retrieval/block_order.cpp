// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/block_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sparse_mocap/base/ordered_work.hpp"

namespace sparse_mocap::retrieval {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr std::size_t kRowsOfAPiece = 16384;  // a thread's share is made of such parts

class BlockOrder {
 public:
  BlockOrder(const Rows& features, std::span<const std::uint32_t> listed, std::size_t block_rows)
      : features_(features), listed_(listed), block_rows_(block_rows), order_(listed.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
  }

  std::vector<std::uint32_t> sorted(int num_threads) {
    const auto pieces = split({{0, order_.size()}}, kRowsOfAPiece);
    in_pieces(pieces.size(), 1, num_threads,
              [&](std::size_t i) { split({pieces[i]}, block_rows_); });
    return std::move(order_);
  }

 private:
  struct Part {
    std::size_t begin, end;
  };

  // Splits parts until none has more rows than that; gives them.
  std::vector<Part> split(std::vector<Part> parts, std::size_t most_rows) {
    std::vector<Part> small;
    std::vector<std::pair<float, std::uint32_t>> keyed;
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      if (part.end - part.begin <= std::max(most_rows, block_rows_)) {
        small.push_back(part);
        continue;
      }
      const std::size_t middle = halve(part, keyed);
      parts.push_back({part.begin, middle});
      parts.push_back({middle, part.end});
    }
    return small;
  }

  // Puts the lower half of a part, in the dimension in which it varies most, before the upper one.
  std::size_t halve(const Part& part, std::vector<std::pair<float, std::uint32_t>>& keyed) {
    const Eigen::Index dimension = widest(part);
    keyed.clear();
    for (std::size_t i = part.begin; i < part.end; ++i)
      keyed.emplace_back(features_(listed_[order_[i]], dimension), order_[i]);
    // Full blocks on the left.
    const std::size_t num_blocks = (keyed.size() + block_rows_ - 1) / block_rows_;
    const std::size_t middle = num_blocks / 2 * block_rows_;
    std::nth_element(keyed.begin(), keyed.begin() + static_cast<std::ptrdiff_t>(middle),
                     keyed.end());
    for (std::size_t i = 0; i < keyed.size(); ++i) order_[part.begin + i] = keyed[i].second;
    return part.begin + middle;
  }

  // By some of the rows.
  Eigen::Index widest(const Part& part) const {
    constexpr std::size_t kMostLookedAt = 128;
    const std::size_t step = std::max<std::size_t>(1, (part.end - part.begin) / kMostLookedAt);
    Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(features_.cols()), squares = sum;
    float looked_at = 0.0F;
    for (std::size_t i = part.begin; i < part.end; i += step) {
      const auto row = features_.row(listed_[order_[i]]).array().transpose();
      sum += row;
      squares += row.square();
      looked_at += 1.0F;
    }
    Eigen::Index dimension = 0;
    (squares - sum.square() / looked_at).maxCoeff(&dimension);
    return dimension;
  }

  const Rows& features_;
  std::span<const std::uint32_t> listed_;
  std::size_t block_rows_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::vector<std::uint32_t> block_order(const Rows& features, std::span<const std::uint32_t> listed,
                                       std::size_t block_rows, int num_threads) {
  return BlockOrder(features, listed, block_rows).sorted(num_threads);
}

}  // namespace sparse_mocap::retrieval
