// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/block_scan.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "sparse_mocap/retrieval/block_kernels.hpp"

namespace sparse_mocap::retrieval {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kSampledEach = 16;      // every so many rows are in the sample
constexpr std::size_t kFirst = 8, kStep = 4;  // dimensions looked at before a block is given up
// Floats round a squared distance by less than this part of it.
constexpr float kRelative = 1e-5F;
// And a turned row by less than this part of its length.
constexpr double kOfLength = 3e-7;

// Where the values of the padding of the last block lie: too far to be near anything.
constexpr float kFar = 1e15F;

// The index, in the node's list, that a kd-split puts between its halves: full blocks on the left.
std::size_t split_of(std::size_t count, std::size_t block) {
  const std::size_t num_blocks = (count + block - 1) / block;
  return num_blocks / 2 * block;
}

// The dimension in which a part of the rows, some of them looked at, varies most.
Eigen::Index widest(const BlockScan::Rows& rows, const std::uint32_t* begin, std::size_t count) {
  constexpr std::size_t kMostLookedAt = 128;
  const std::size_t step = std::max<std::size_t>(1, count / kMostLookedAt);
  Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(rows.cols()), squares = sum;
  float looked_at = 0.0F;
  for (std::size_t i = 0; i < count; i += step) {
    const auto row = rows.row(begin[i]).array().transpose();
    sum += row;
    squares += row.square();
    looked_at += 1.0F;
  }
  Eigen::Index dimension = 0;
  (squares - sum.square() / looked_at).maxCoeff(&dimension);
  return dimension;
}

}  // namespace

// A query on the principal axes.
struct BlockScan::Query {
  std::vector<float> turned;
  float rounding = 0.0F;  // of a distance (not squared), by turning rows and query

  // What a squared distance may be for one that is `squared` in exact arithmetic.
  float at_most(float squared) const {
    const float distance = std::sqrt(squared) + rounding;
    return distance * distance * (1.0F + kRelative);
  }
};

BlockScan::BlockScan(const Rows& features, std::span<const std::uint32_t> listed)
    : num_rows_(listed.size()),
      num_dimensions_(static_cast<std::size_t>(features.cols())),
      num_blocks_((num_rows_ + kBlock - 1) / kBlock) {
  const auto dimensions = features.cols();
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(dimensions, dimensions);
  mean_ = Eigen::VectorXd::Zero(dimensions);
  for (const auto row : listed) mean_ += features.row(row).cast<double>().transpose();
  mean_ /= static_cast<double>(num_rows_);
  for (std::size_t i = 0; i < num_rows_; i += kSampledEach) {
    const Eigen::VectorXd off = features.row(listed[i]).cast<double>().transpose() - mean_;
    squares.selfadjointView<Eigen::Lower>().rankUpdate(off);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(squares);
  R_feature_axes_ = axes.eigenvectors().rowwise().reverse();
  Rows turned(static_cast<Eigen::Index>(num_rows_), dimensions);
  for (std::size_t i = 0; i < num_rows_; ++i) {
    const Eigen::VectorXd row =
        R_feature_axes_.transpose() * (features.row(listed[i]).cast<double>().transpose() - mean_);
    turned.row(static_cast<Eigen::Index>(i)) = row.cast<float>().transpose();
    largest_norm_ = std::max(largest_norm_, row.norm());
  }
  fill_blocks(turned, block_order(turned));
  fill_sample(turned);
}

// Places in the list, sorted by a kd-split into blocks.
std::vector<std::uint32_t> BlockScan::block_order(const Rows& turned) const {
  std::vector<std::uint32_t> order(num_rows_);
  std::iota(order.begin(), order.end(), 0U);
  std::vector<std::pair<float, std::uint32_t>> keyed;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, num_rows_}};
  while (!parts.empty()) {
    const auto [begin, end] = parts.back();
    parts.pop_back();
    const std::size_t count = end - begin;
    if (count <= kBlock) continue;
    const Eigen::Index dimension = widest(turned, order.data() + begin, count);
    keyed.clear();
    for (std::size_t i = begin; i < end; ++i)
      keyed.emplace_back(turned(order[i], dimension), order[i]);
    const std::size_t middle = split_of(count, kBlock);
    std::nth_element(keyed.begin(), keyed.begin() + static_cast<std::ptrdiff_t>(middle),
                     keyed.end());
    for (std::size_t i = 0; i < count; ++i) order[begin + i] = keyed[i].second;
    parts.emplace_back(begin, begin + middle);
    parts.emplace_back(begin + middle, end);
  }
  return order;
}

void BlockScan::fill_blocks(const Rows& turned, const std::vector<std::uint32_t>& order) {
  blocks_.assign(num_blocks_ * num_dimensions_ * kBlock, kFar);
  low_.assign(num_dimensions_ * num_blocks_, kInfinity);
  high_.assign(num_dimensions_ * num_blocks_, -kInfinity);
  places_ = order;
  for (std::size_t i = 0; i < num_rows_; ++i) {
    const std::size_t block = i / kBlock;
    for (std::size_t d = 0; d < num_dimensions_; ++d) {
      const float value = turned(order[i], static_cast<Eigen::Index>(d));
      blocks_[(block * num_dimensions_ + d) * kBlock + i % kBlock] = value;
      float& low = low_[d * num_blocks_ + block];
      float& high = high_[d * num_blocks_ + block];
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
}

void BlockScan::fill_sample(const Rows& turned) {
  num_sampled_ = (num_rows_ + kSampledEach - 1) / kSampledEach;
  sample_.resize(num_dimensions_ * num_sampled_);
  for (std::size_t i = 0; i < num_sampled_; ++i)
    for (std::size_t d = 0; d < num_dimensions_; ++d)
      sample_[d * num_sampled_ + i] =
          turned(static_cast<Eigen::Index>(i * kSampledEach), static_cast<Eigen::Index>(d));
}

// A squared distance within which the k nearest rows most likely are: that of a row of the sample
// which has a few more nearer to the query than k rows' share.
float BlockScan::sampled_bound(const Query& query, std::size_t k) const {
  const double share = static_cast<double>(k) / kSampledEach;
  const auto rank = static_cast<std::size_t>(std::ceil(share + 2.5 * std::sqrt(share) + 4.0));
  if (rank >= num_sampled_) return kInfinity;
  static thread_local std::vector<float> squared;
  squared.assign(num_sampled_, 0.0F);
  constexpr std::size_t kChunk = 2048;  // stays in the nearest cache
  for (std::size_t begin = 0; begin < num_sampled_; begin += kChunk) {
    const std::size_t count = std::min(kChunk, num_sampled_ - begin);
    for (std::size_t d = 0; d < num_dimensions_; ++d)
      block_kernels().add_squares(query.turned[d], &sample_[d * num_sampled_ + begin], count,
                                  &squared[begin]);
  }
  const auto at = squared.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(squared.begin(), at, squared.end());
  return *at;
}

// Collects the rows within the bound; false when those are fewer than k.
bool BlockScan::scan(const Query& query, std::size_t k, float bound,
                     std::vector<std::uint32_t>& places) const {
  const BlockKernels& kernels = block_kernels();
  static thread_local std::vector<float> box_distance;
  box_distance.assign(num_blocks_, 0.0F);
  for (std::size_t d = 0; d < num_dimensions_; ++d)
    kernels.add_outside(query.turned[d], &low_[d * num_blocks_], &high_[d * num_blocks_],
                        num_blocks_, box_distance.data());
  const float limit = query.at_most(query.at_most(bound));
  std::size_t num_within = 0;
  places.clear();
  for (std::size_t b = 0; b < num_blocks_; ++b) {
    if (box_distance[b] > limit) continue;
    const float* block = &blocks_[b * num_dimensions_ * kBlock];
    std::array<float, kBlock> squared{};
    std::size_t done = 0;
    bool is_near = true;
    for (std::size_t next = std::min(kFirst, num_dimensions_); is_near && done < num_dimensions_;
         next = std::min(next + kStep, num_dimensions_)) {
      is_near = kernels.add_block(query.turned.data(), block, done, next, limit, squared.data());
      done = next;
    }
    if (!is_near) continue;
    const std::size_t count = std::min(kBlock, num_rows_ - b * kBlock);
    for (std::size_t i = 0; i < count; ++i) {
      if (squared[i] > limit) continue;
      num_within += squared[i] <= bound ? 1 : 0;
      places.push_back(places_[b * kBlock + i]);
    }
  }
  return num_within >= k;
}

void BlockScan::near_rows(std::span<const float> query, std::size_t k,
                          std::vector<std::uint32_t>& places) const {
  const Eigen::VectorXd off =
      Eigen::Map<const Eigen::VectorXf>(query.data(), static_cast<Eigen::Index>(query.size()))
          .cast<double>() -
      mean_;
  const Eigen::VectorXd turned = R_feature_axes_.transpose() * off;
  Query on_axes;
  on_axes.turned.assign(num_dimensions_, 0.0F);
  for (std::size_t d = 0; d < num_dimensions_; ++d)
    on_axes.turned[d] = static_cast<float>(turned[static_cast<Eigen::Index>(d)]);
  on_axes.rounding = static_cast<float>(kOfLength * (largest_norm_ + turned.norm()));
  float bound = sampled_bound(on_axes, k);
  // Without a finite bound, as for a query that is infinite, all rows are near.
  while (!scan(on_axes, k, bound, places) && std::isfinite(bound))
    bound = bound > 0.0F ? 2.0F * bound : on_axes.at_most(0.0F) + 1e-30F;
}

}  // namespace sparse_mocap::retrieval
