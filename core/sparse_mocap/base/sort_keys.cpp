// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/sort_keys.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace sparse_mocap {
namespace {

constexpr int kDigitBits = 8;
constexpr std::size_t kNumValues = std::size_t{1} << kDigitBits;
constexpr std::size_t kFewKeys = 128;  // comparing is faster

using Counts = std::array<std::uint32_t, kNumValues>;

std::size_t digit_of(std::uint64_t key, std::size_t digit) {
  return (key >> (digit * kDigitBits)) & (kNumValues - 1);
}

}  // namespace

void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch) {
  if (keys.size() <= kFewKeys) return std::sort(keys.begin(), keys.end());
  std::array<Counts, sizeof(std::uint64_t)> counts{};
  for (const auto key : keys)
    for (std::size_t digit = 0; digit < counts.size(); ++digit)
      ++counts[digit][digit_of(key, digit)];
  scratch.resize(keys.size());
  for (std::size_t digit = 0; digit < counts.size(); ++digit) {
    Counts& next = counts[digit];
    if (next[digit_of(keys.front(), digit)] == keys.size()) continue;  // all alike
    std::uint32_t begin = 0;
    for (auto& count : next) begin += std::exchange(count, begin);
    for (const auto key : keys) scratch[next[digit_of(key, digit)]++] = key;
    std::swap(keys, scratch);
  }
}

}  // namespace sparse_mocap
