// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/block_kernels.hpp"

#include <algorithm>
#include <cstring>

namespace sparse_mocap::retrieval {
namespace {

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

// Eight rows at a time, by the compilers' own vectors: left to itself, GCC takes two dimensions at
// once and one row at a time here.
constexpr std::size_t kLanes = 8;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Integers = std::int32_t __attribute__((vector_size(4 * kLanes)));

[[gnu::always_inline]] inline bool block(const CoarseBlock& block,
                                         std::span<const AskedValue> asked, float bound,
                                         float* sums) {
  constexpr std::size_t kVectors = kBlockRows / kLanes;
  Floats total[kVectors];
  std::memcpy(total, sums, sizeof(total));
  for (const auto& [dimension, value] : asked) {
    const std::uint8_t* codes = block.codes + dimension * kBlockRows;
    const float low = block.low[dimension * kGroupBlocks];
    const float step = (block.high[dimension * kGroupBlocks] - low) * (1.0F / 255.0F);
    const float off = low - value;
    for (std::size_t v = 0; v < kVectors; ++v) {
      Integers whole;
      for (std::size_t i = 0; i < kLanes; ++i) whole[i] = codes[v * kLanes + i];
      const Floats difference = off + step * __builtin_convertvector(whole, Floats);
      total[v] += difference * difference;
    }
  }
  std::memcpy(sums, total, sizeof(total));
  Integers is_near{};
  for (const Floats& squares : total) is_near |= squares <= bound;
  std::int32_t any = 0;
  for (std::size_t i = 0; i < kLanes; ++i) any |= is_near[i];
  return any != 0;
}

struct Plain {
  static void add_squares(float q, const float* v, std::size_t n, float* s) { squares(q, v, n, s); }
  static void add_outside(float q, const float* l, const float* h, std::size_t n, float* s) {
    outside(q, l, h, n, s);
  }
  static bool add_block(const CoarseBlock& b, std::span<const AskedValue> a, float bound,
                        float* s) {
    return block(b, a, bound, s);
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
  SPARSE_MOCAP_AVX2 static bool add_block(const CoarseBlock& b, std::span<const AskedValue> a,
                                          float bound, float* s) {
    return block(b, a, bound, s);
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
