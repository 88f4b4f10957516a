// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace sparse_mocap {

// The safetensors container: a length-prefixed JSON header, then contiguous little-endian arrays.
// Knows nothing of motion, nor of what else this project asks of its files (container.hpp).

// All types of whole bytes that the format has.
enum class ElementType {
  boolean,
  u8,
  i8,
  f8_e5m2,
  f8_e4m3,
  f8_e8m0,
  u16,
  i16,
  f16,
  bf16,
  u32,
  i32,
  f32,
  u64,
  i64,
  f64,
  c64
};

// As the format calls it: "F32".
const char* name_of(ElementType type);
std::size_t size_of(ElementType type);  // bytes

// The element type of a C++ number.
template <typename Scalar>
inline constexpr ElementType kElementTypeOf = Scalar::is_no_element_type;
template <>
inline constexpr ElementType kElementTypeOf<std::uint8_t> = ElementType::u8;
template <>
inline constexpr ElementType kElementTypeOf<std::int16_t> = ElementType::i16;
template <>
inline constexpr ElementType kElementTypeOf<std::int32_t> = ElementType::i32;
template <>
inline constexpr ElementType kElementTypeOf<std::int64_t> = ElementType::i64;
template <>
inline constexpr ElementType kElementTypeOf<float> = ElementType::f32;
template <>
inline constexpr ElementType kElementTypeOf<double> = ElementType::f64;

// An array that lies somewhere else, the last index running fastest.
struct Tensor {
  std::string name;
  ElementType type = ElementType::f32;
  std::vector<std::size_t> shape;  // empty: a single value
  std::span<const std::byte> bytes;
};

struct SafetensorsView {
  std::map<std::string, std::string> metadata;
  std::vector<Tensor> tensors;  // views into the parsed bytes, in the order of the file

  // Null when there is none of this name.
  const Tensor* find(const std::string& name) const;
};

// The file's header, padded so that the arrays behind it start on a 64-byte boundary. The tensors'
// bytes are not looked at. Throws std::invalid_argument when a text is not UTF-8.
std::string safetensors_header(const std::map<std::string, std::string>& metadata,
                               const std::vector<Tensor>& tensors);

// Checks every rule of the format before anything is used: header size, duplicate keys, known
// types, sizes without overflow, arrays contiguous and covering the file exactly. Throws
// std::invalid_argument: "the header is not JSON".
SafetensorsView parse_safetensors(std::span<const std::byte> file);

}  // namespace sparse_mocap
