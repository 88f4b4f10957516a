// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace sparse_mocap {

// XXH3 (64 bit) as 16 hexadecimal digits.
std::string checksum(std::span<const std::byte> bytes);
// The same of what the pieces hold one after another.
std::string checksum_of_pieces(std::span<const std::span<const std::byte>> pieces);

}  // namespace sparse_mocap
