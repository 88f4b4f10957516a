// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/sort_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sparse_mocap {
namespace {

using Keys = std::vector<std::uint64_t>;

void expect_sorted(Keys keys) {
  Keys expected = keys, scratch{7, 7, 7};
  std::sort(expected.begin(), expected.end());
  sort_keys(keys, scratch);
  EXPECT_EQ(keys, expected);
}

TEST(SortKeys, SortsAnyNumberOfThem) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0U, 1U, 2U, 128U, 129U, 255U, 256U, 257U, 5000U, 70'000U})
    for (const std::uint64_t most : {~0ULL, 0xFFFF'FFFFULL, 0xFF00'0000'0000'00FFULL, 3ULL, 0ULL}) {
      Keys keys(count);
      for (auto& key : keys) key = random() & most;
      expect_sorted(keys);
    }
}

TEST(SortKeys, SortsKeysThatDifferInOneDigit) {
  for (int shift = 0; shift < 64; shift += 8) {
    Keys keys;
    for (std::uint64_t i = 300; i-- > 0;) keys.push_back((i % 256) << shift);
    expect_sorted(keys);
  }
}

}  // namespace
}  // namespace sparse_mocap
