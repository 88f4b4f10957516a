// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "sparse_mocap/streams/stream_parser.hpp"

namespace sparse_mocap::streams {

// Reads and writes binary numbers. Callers have checked that there are enough bytes.
template <std::endian order, typename T>
T read_number(const std::uint8_t* at) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes[i] = at[order == std::endian::native ? i : sizeof(T) - 1 - i];
  return std::bit_cast<T>(bytes);
}

template <std::endian order, typename T>
void append_number(Bytes& out, T value) {
  const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out.push_back(bytes[order == std::endian::native ? i : sizeof(T) - 1 - i]);
}

template <typename T>
T read_big(const std::uint8_t* at) {
  return read_number<std::endian::big, T>(at);
}

template <typename T>
T read_little(const std::uint8_t* at) {
  return read_number<std::endian::little, T>(at);
}

template <typename T>
void append_big(Bytes& out, T value) {
  append_number<std::endian::big>(out, value);
}

template <typename T>
void append_little(Bytes& out, T value) {
  append_number<std::endian::little>(out, value);
}

}  // namespace sparse_mocap::streams
