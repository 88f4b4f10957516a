// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/base/checksum.hpp"

namespace sparse_mocap {

// The safetensors container: a length-prefixed JSON header, then contiguous little-endian arrays.
// Knows nothing of motion.

enum class ElementType { f32, i32 };

std::size_t size_of(ElementType type);

struct Tensor {
  std::string name;
  ElementType type = ElementType::f32;
  std::vector<std::size_t> shape;
  std::span<const std::byte> bytes;
};

struct SafetensorsView {
  std::map<std::string, std::string> metadata;
  std::vector<Tensor> tensors;  // views into the parsed bytes

  // Throws FormatError naming path when there is no such array.
  const Tensor& find(const std::string& name, const std::filesystem::path& path) const;
};

// The file's header, padded so that the arrays behind it start on a 64-byte boundary. The tensors'
// bytes are not looked at.
std::string safetensors_header(const std::map<std::string, std::string>& metadata,
                               const std::vector<Tensor>& tensors);

// Checks every rule of the format before anything is used: header size, duplicate keys, known
// types, sizes without overflow, arrays contiguous and covering the file exactly. Throws
// FormatError naming path.
SafetensorsView parse_safetensors(std::span<const std::byte> file,
                                  const std::filesystem::path& path);

// The checksum over all entries but kMetadataChecksum, which holds it.
inline constexpr char kMetadataChecksum[] = "metadata_checksum";
std::string metadata_checksum(const std::map<std::string, std::string>& metadata);

}  // namespace sparse_mocap
