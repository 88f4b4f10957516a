// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/checksum.hpp"

#include <xxhash.h>

#include <cstdint>

namespace sparse_mocap {

std::string checksum(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::uint64_t hash = XXH3_64bits(bytes.data(), bytes.size());
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, hash >>= 4)
    *digit = kDigits[hash & 0xF];
  return text;
}

}  // namespace sparse_mocap
