// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sparse_mocap::retrieval {

inline constexpr std::size_t kBlockRows = 64;    // in a block
inline constexpr std::size_t kGroupBlocks = 16;  // in a group

// A block of 64 rows, coarsely: a value is low + code * (high - low) / 255.
struct CoarseBlock {
  const std::uint8_t* codes;  // [dimension][row]
  const float* low;           // of dimension d at d * kGroupBlocks
  const float* high;
};

// A value that is asked for, and the dimension that it belongs to.
struct AskedValue {
  std::size_t dimension;
  float value;
};

// The inner loops of BlockScan, compiled for the plain processor and for wider vectors, of which
// the widest that this processor has are used. Distances may differ in their last digits from one
// to the other, which BlockScan allows for.
struct BlockKernels {
  // sums[i] += (query - values[i])^2
  void (*add_squares)(float query, const float* values, std::size_t count, float* sums);
  // sums[i] += (how far the query lies outside [low[i], high[i]])^2
  void (*add_outside)(float query, const float* low, const float* high, std::size_t count,
                      float* sums);
  // The squared distances of a block's 64 rows in some dimensions, added to sums. Returns whether
  // one of them is at most `bound`.
  bool (*add_block)(const CoarseBlock& block, std::span<const AskedValue> asked, float bound,
                    float* sums);
};

const BlockKernels& block_kernels();

}  // namespace sparse_mocap::retrieval
