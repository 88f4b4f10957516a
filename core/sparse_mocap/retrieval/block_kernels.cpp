// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/block_kernels.hpp"

#include <algorithm>

namespace sparse_mocap::retrieval {
namespace {

constexpr std::size_t kBlock = 64;

// What each kernel does, to be compiled once for each kind of processor.
[[gnu::always_inline]] inline void squares(float query, const float* __restrict values,
                                           std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const float difference = query - values[i];
    sums[i] += difference * difference;
  }
}

[[gnu::always_inline]] inline void outside(float query, const float* __restrict low,
                                           const float* __restrict high, std::size_t count,
                                           float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const float below = low[i] - query, above = query - high[i];
    const float out = std::max(std::max(below, above), 0.0F);
    sums[i] += out * out;
  }
}

[[gnu::always_inline]] inline bool block(const float* __restrict query,
                                         const float* __restrict values, std::size_t begin,
                                         std::size_t end, float bound, float* __restrict sums) {
  for (std::size_t d = begin; d < end; ++d) squares(query[d], values + d * kBlock, kBlock, sums);
  int num_near = 0;
  for (std::size_t i = 0; i < kBlock; ++i) num_near += sums[i] <= bound ? 1 : 0;
  return num_near > 0;
}

struct Plain {
  static void add_squares(float q, const float* v, std::size_t n, float* s) { squares(q, v, n, s); }
  static void add_outside(float q, const float* l, const float* h, std::size_t n, float* s) {
    outside(q, l, h, n, s);
  }
  static bool add_block(const float* q, const float* v, std::size_t b, std::size_t e, float bound,
                        float* s) {
    return block(q, v, b, e, bound, s);
  }
};

#if defined(__x86_64__)
#define SPARSE_MOCAP_AVX2 [[gnu::target("avx2,fma")]]
struct Avx2 {
  SPARSE_MOCAP_AVX2 static void add_squares(float q, const float* v, std::size_t n, float* s) {
    squares(q, v, n, s);
  }
  SPARSE_MOCAP_AVX2 static void add_outside(float q, const float* l, const float* h, std::size_t n,
                                            float* s) {
    outside(q, l, h, n, s);
  }
  SPARSE_MOCAP_AVX2 static bool add_block(const float* q, const float* v, std::size_t b,
                                          std::size_t e, float bound, float* s) {
    return block(q, v, b, e, bound, s);
  }
};
#undef SPARSE_MOCAP_AVX2
#endif

template <typename Kind>
BlockKernels kernels() {
  return {&Kind::add_squares, &Kind::add_outside, &Kind::add_block};
}

BlockKernels fastest() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return kernels<Avx2>();
#endif
  return kernels<Plain>();
}

}  // namespace

const BlockKernels& block_kernels() {
  static const BlockKernels chosen = fastest();
  return chosen;
}

}  // namespace sparse_mocap::retrieval
