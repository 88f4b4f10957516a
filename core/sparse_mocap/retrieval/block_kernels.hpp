// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace sparse_mocap::retrieval {

// The inner loops of BlockScan, compiled for the plain processor and for wider vectors, of which
// the widest that this processor has are used. Distances may differ in their last digits from one
// to the other, which BlockScan allows for.
struct BlockKernels {
  // sums[i] += (query - values[i])^2
  void (*add_squares)(float query, const float* values, std::size_t count, float* sums);
  // sums[i] += (how far the query lies outside [low[i], high[i]])^2
  void (*add_outside)(float query, const float* low, const float* high, std::size_t count,
                      float* sums);
  // The squared distances of a block of 64 rows in dimensions [begin, end), added to sums. Returns
  // whether one of them is at most `bound`.
  bool (*add_block)(const float* query, const float* block, std::size_t begin, std::size_t end,
                    float bound, float* sums);
};

const BlockKernels& block_kernels();

}  // namespace sparse_mocap::retrieval
