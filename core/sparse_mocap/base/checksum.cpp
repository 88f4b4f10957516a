// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/checksum.hpp"

#include <xxhash.h>

#include <cstdint>

namespace sparse_mocap {
namespace {

std::string hexadecimal(std::uint64_t hash) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, hash >>= 4)
    *digit = kDigits[hash & 0xF];
  return text;
}

}  // namespace

std::string checksum(std::span<const std::byte> bytes) {
  return hexadecimal(XXH3_64bits(bytes.data(), bytes.size()));
}

std::string checksum_of_pieces(std::span<const std::span<const std::byte>> pieces) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  for (const auto piece : pieces) XXH3_64bits_update(&state, piece.data(), piece.size());
  return hexadecimal(XXH3_64bits_digest(&state));
}

}  // namespace sparse_mocap
