// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/block_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/retrieval/block_order.hpp"

namespace sparse_mocap::retrieval {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kSampledEach = 32;      // every so many rows are in the sample
constexpr std::size_t kFirst = 8, kStep = 4;  // dimensions looked at before blocks are given up
constexpr float kMostCode = 255.0F;
// Floats round a distance by less than this part of it, and by less than that of the numbers that
// it is a difference of.
constexpr float kRelative = 1e-5F, kOfLength = 1e-6F;

float squared(float x) { return x * x; }

}  // namespace

// What an index is made of.
struct BlockScan::Source {
  const Rows& features;
  std::span<const std::uint32_t> listed;
  int num_threads;

  float value(std::size_t place, std::size_t dimension) const {
    return features(listed[place], static_cast<Eigen::Index>(dimension));
  }
};

// What is asked for, in the dimensions that are known.
struct BlockScan::Query {
  std::vector<AskedValue> values;  // the most varied dimension first
  float rounding = 0.0F;           // of a distance

  // How far away rows may look that are no farther than a radius.
  float reach(float radius) const { return radius * (1.0F + kRelative) + rounding; }
};

// Rows that may be within a radius, and how far each is at most.
struct BlockScan::Candidates {
  std::vector<std::uint32_t>& places;
  std::vector<float>& at_most;

  std::size_t num_surely_within(float radius) const {
    return static_cast<std::size_t>(std::count_if(
        at_most.begin(), at_most.end(), [=](float distance) { return distance <= radius; }));
  }
  // A distance within which k rows certainly are; these are at least k.
  float surely_within(std::size_t k) const {
    const auto kth = at_most.begin() + static_cast<std::ptrdiff_t>(k) - 1;
    std::nth_element(at_most.begin(), kth, at_most.end());
    return *kth;
  }
};

BlockScan::BlockScan(const Rows& features, std::span<const std::uint32_t> listed, int num_threads)
    : num_rows_(listed.size()),
      num_dimensions_(static_cast<std::size_t>(features.cols())),
      num_blocks_((num_rows_ + kBlockRows - 1) / kBlockRows),
      num_groups_((num_blocks_ + kGroupBlocks - 1) / kGroupBlocks),
      places_(block_order(features, listed, kBlockRows, num_threads)) {
  const Source rows{features, listed, num_threads};
  order_dimensions(rows);
  fill_blocks(rows);
  fill_groups();
  fill_sample(rows);
}

void BlockScan::order_dimensions(const Source& rows) {
  std::vector<double> variance(num_dimensions_);
  for (std::size_t d = 0; d < num_dimensions_; ++d) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < num_rows_; i += kSampledEach) {
      const double value = double{rows.value(i, d)};
      sum += value;
      squares += value * value;
      count += 1.0;
    }
    variance[d] = squares / count - sum * sum / (count * count);
  }
  dimensions_.resize(num_dimensions_);
  std::iota(dimensions_.begin(), dimensions_.end(), std::size_t{0});
  std::stable_sort(dimensions_.begin(), dimensions_.end(),
                   [&](std::size_t a, std::size_t b) { return variance[a] > variance[b]; });
}

void BlockScan::fill_blocks(const Source& rows) {
  codes_.assign(num_blocks_ * num_dimensions_ * kBlockRows, 0);
  error_.assign(num_blocks_, 0.0F);
  low_.assign(num_groups_ * num_dimensions_ * kGroupBlocks, kInfinity);
  high_.assign(low_.size(), -kInfinity);
  in_pieces(num_blocks_, 256, rows.num_threads, [&](std::size_t b) { fill_block(rows, b); });
}

void BlockScan::fill_block(const Source& rows, std::size_t block) {
  const std::size_t begin = block * kBlockRows, end = std::min(begin + kBlockRows, num_rows_);
  float squared_steps = 0.0F;
  for (std::size_t d = 0; d < num_dimensions_; ++d) {
    std::array<float, kBlockRows> values{};
    for (std::size_t i = begin; i < end; ++i) values[i - begin] = rows.value(places_[i], d);
    const auto [low, high] = std::minmax_element(values.begin(), values.begin() + (end - begin));
    const std::size_t at =
        (block / kGroupBlocks * num_dimensions_ + d) * kGroupBlocks + block % kGroupBlocks;
    low_[at] = *low;
    high_[at] = *high;
    const float step = (*high - *low) / kMostCode;
    squared_steps += squared(step);
    if (!(step > 0.0F)) continue;
    std::uint8_t* codes = &codes_[(block * num_dimensions_ + d) * kBlockRows];
    for (std::size_t i = 0; i < end - begin; ++i)
      codes[i] = static_cast<std::uint8_t>(
          std::clamp(std::round((values[i] - *low) / step), 0.0F, kMostCode));
  }
  error_[block] = 0.5F * std::sqrt(squared_steps) * (1.0F + kRelative);
}

// Boxes of the groups, and how long rows are at most.
void BlockScan::fill_groups() {
  group_low_.assign(num_dimensions_ * num_groups_, kInfinity);
  group_high_.assign(group_low_.size(), -kInfinity);
  float squared_norm = 0.0F;
  for (std::size_t d = 0; d < num_dimensions_; ++d) {
    float longest = 0.0F;
    for (std::size_t g = 0; g < num_groups_; ++g) {
      const std::size_t at = (g * num_dimensions_ + d) * kGroupBlocks;
      float& low = group_low_[d * num_groups_ + g];
      float& high = group_high_[d * num_groups_ + g];
      low = *std::min_element(&low_[at], &low_[at] + kGroupBlocks);
      high = *std::max_element(&high_[at], &high_[at] + kGroupBlocks);
      longest = std::max({longest, std::abs(low), std::abs(high)});
    }
    squared_norm += squared(longest);
  }
  largest_norm_ = std::sqrt(squared_norm);
}

void BlockScan::fill_sample(const Source& rows) {
  num_sampled_ = (num_rows_ + kSampledEach - 1) / kSampledEach;
  sample_.resize(num_dimensions_ * num_sampled_);
  for (std::size_t i = 0; i < num_sampled_; ++i)
    for (std::size_t d = 0; d < num_dimensions_; ++d)
      sample_[d * num_sampled_ + i] = rows.value(i * kSampledEach, d);
}

CoarseBlock BlockScan::coarse_block(std::size_t block) const {
  const std::size_t at =
      block / kGroupBlocks * num_dimensions_ * kGroupBlocks + block % kGroupBlocks;
  return {&codes_[block * num_dimensions_ * kBlockRows], &low_[at], &high_[at]};
}

// A distance within which the k nearest rows most likely are: that of a row of the sample which has
// a few more nearer to the query than k rows' share.
float BlockScan::sampled_radius(const Query& query, std::size_t k) const {
  const double share = static_cast<double>(k) / kSampledEach;
  const auto rank = static_cast<std::size_t>(std::ceil(share + 2.5 * std::sqrt(share) + 4.0));
  if (rank >= num_sampled_) return kInfinity;
  static thread_local std::vector<float> distances;
  distances.assign(num_sampled_, 0.0F);
  constexpr std::size_t kChunk = 2048;  // stays in the nearest cache
  for (std::size_t begin = 0; begin < num_sampled_; begin += kChunk) {
    const std::size_t count = std::min(kChunk, num_sampled_ - begin);
    for (const auto& [dimension, value] : query.values)
      block_kernels().add_squares(value, &sample_[dimension * num_sampled_ + begin], count,
                                  &distances[begin]);
  }
  const auto at = distances.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(distances.begin(), at, distances.end());
  return std::sqrt(*at);
}

// Collects the rows that may be within the radius.
void BlockScan::scan(const Query& query, float radius, Candidates& found) const {
  static thread_local std::vector<float> outside;
  outside.assign(num_groups_, 0.0F);
  for (const auto& [dimension, value] : query.values)
    block_kernels().add_outside(value, &group_low_[dimension * num_groups_],
                                &group_high_[dimension * num_groups_], num_groups_, outside.data());
  const float limit = squared(query.reach(radius));
  found.places.clear();
  found.at_most.clear();
  for (std::size_t g = 0; g < num_groups_; ++g)
    if (outside[g] <= limit) scan_group(query, radius, g, found);
}

void BlockScan::scan_group(const Query& query, float radius, std::size_t group,
                           Candidates& found) const {
  std::array<float, kGroupBlocks> outside{};
  const float limit = squared(query.reach(radius));
  std::size_t done = 0;
  for (const auto& [dimension, value] : query.values) {
    const std::size_t at = (group * num_dimensions_ + dimension) * kGroupBlocks;
    block_kernels().add_outside(value, &low_[at], &high_[at], kGroupBlocks, outside.data());
    if (++done % kFirst == 0 && *std::min_element(outside.begin(), outside.end()) > limit) return;
  }
  const std::size_t begin = group * kGroupBlocks;
  for (std::size_t i = 0; i < std::min(kGroupBlocks, num_blocks_ - begin); ++i)
    if (outside[i] <= limit) scan_block(query, radius, begin + i, found);
}

void BlockScan::scan_block(const Query& query, float radius, std::size_t block,
                           Candidates& found) const {
  const CoarseBlock coarse = coarse_block(block);
  const float limit = squared(query.reach(radius) + error_[block]);
  const std::span<const AskedValue> asked = query.values;
  std::array<float, kBlockRows> distances{};
  for (std::size_t done = 0; done < asked.size();) {
    const std::size_t count = std::min(done == 0 ? kFirst : kStep, asked.size() - done);
    if (!block_kernels().add_block(coarse, asked.subspan(done, count), limit, distances.data()))
      return;
    done += count;
  }
  const std::size_t begin = block * kBlockRows;
  for (std::size_t i = 0; i < std::min(kBlockRows, num_rows_ - begin); ++i) {
    if (distances[i] > limit) continue;
    found.places.push_back(places_[begin + i]);
    found.at_most.push_back(query.reach(std::sqrt(distances[i])) + error_[block]);
  }
}

void BlockScan::near_rows(std::span<const float> query, std::size_t k,
                          std::vector<std::uint32_t>& places) const {
  static thread_local Query asked;
  asked.values.clear();
  float squared_norm = 0.0F;
  for (const std::size_t d : dimensions_) {
    if (std::isnan(query[d])) continue;
    asked.values.push_back({d, query[d]});
    squared_norm += squared(query[d]);
  }
  asked.rounding = kOfLength * (largest_norm_ + std::sqrt(squared_norm)) + 1e-30F;
  static thread_local std::vector<float> at_most;
  Candidates found{places, at_most};
  float radius = sampled_radius(asked, k);
  scan(asked, radius, found);
  while (places.size() < k) scan(asked, radius = 1.5F * radius + asked.rounding, found);
  // Without a finite radius, as for a query that is infinite, all rows are near.
  if (!std::isfinite(radius) || found.num_surely_within(radius) >= k) return;
  scan(asked, found.surely_within(k), found);
}

}  // namespace sparse_mocap::retrieval
