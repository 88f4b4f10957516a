// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace sparse_mocap {

// XXH3 (64 bit) as 16 hexadecimal digits.
std::string checksum(std::span<const std::byte> bytes);

}  // namespace sparse_mocap
