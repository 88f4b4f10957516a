// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/safetensors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/strict_json.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little,
              "arrays are mapped as they are, which needs a little-endian machine");

constexpr std::size_t kPrefixBytes = 8;
constexpr std::size_t kMaxHeaderBytes = 100'000'000;
constexpr std::size_t kMaxTensors = 1024;
constexpr std::size_t kAlignment = 64;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& problem) {
  throw FormatError({path}, "not a sound motion database: " + problem,
                    "build it again with 'sparse-mocap database build'");
}

const char* name_of(ElementType type) { return type == ElementType::f32 ? "F32" : "I32"; }

ElementType type_named(const std::string& name, const std::filesystem::path& path) {
  if (name == "F32") return ElementType::f32;
  if (name == "I32") return ElementType::i32;
  refuse(path, "unknown element type '" + name + "'");
}

json parse_header(const std::string& text, const std::filesystem::path& path) {
  try {
    return parse_json_strictly(text);
  } catch (const std::invalid_argument& error) {
    refuse(path, std::string("the header ") + error.what());
  }
}

std::size_t product(const std::vector<std::size_t>& shape, std::size_t element,
                    const std::filesystem::path& path) {
  std::size_t total = element;
  for (const std::size_t n : shape) {
    if (n != 0 && total > std::numeric_limits<std::size_t>::max() / n)
      refuse(path, "an array's size overflows");
    total *= n;
  }
  return total;
}

Tensor tensor_from(const std::string& name, const json& entry, std::span<const std::byte> data,
                   const std::filesystem::path& path) {
  Tensor tensor;
  tensor.name = name;
  std::array<std::size_t, 2> range{};
  try {
    tensor.type = type_named(entry.at("dtype").get<std::string>(), path);
    for (const auto& n : entry.at("shape")) {
      if (!n.is_number_unsigned()) refuse(path, "array '" + name + "' has a bad shape");
      tensor.shape.push_back(n.get<std::size_t>());
    }
    for (const auto& n : entry.at("data_offsets"))
      if (!n.is_number_unsigned()) refuse(path, "array '" + name + "' has bad offsets");
    range = entry.at("data_offsets").get<std::array<std::size_t, 2>>();
  } catch (const json::exception&) {
    refuse(path, "the description of array '" + name + "' is damaged");
  }
  if (range[0] > range[1] || range[1] > data.size())
    refuse(path, "array '" + name + "' lies outside the file");
  if (product(tensor.shape, size_of(tensor.type), path) != range[1] - range[0])
    refuse(path, "array '" + name + "' has not the size of its shape");
  tensor.bytes = data.subspan(range[0], range[1] - range[0]);
  return tensor;
}

void check_contiguous(SafetensorsView& view, std::span<const std::byte> data,
                      const std::filesystem::path& path) {
  std::sort(view.tensors.begin(), view.tensors.end(), [](const Tensor& a, const Tensor& b) {
    return std::pair(a.bytes.data(), a.bytes.size()) < std::pair(b.bytes.data(), b.bytes.size());
  });
  const std::byte* expected = data.data();
  for (const auto& tensor : view.tensors) {
    if (tensor.bytes.data() != expected) refuse(path, "arrays overlap or leave a hole");
    expected += tensor.bytes.size();
  }
  if (expected != data.data() + data.size()) refuse(path, "bytes follow the last array");
}

std::uint64_t header_size(std::span<const std::byte> file, const std::filesystem::path& path) {
  if (file.size() < kPrefixBytes) refuse(path, "the file is too short");
  std::uint64_t size = 0;
  std::memcpy(&size, file.data(), kPrefixBytes);
  if (size > kMaxHeaderBytes || size > file.size() - kPrefixBytes)
    refuse(path, "the header's length is wrong");
  return size;
}

}  // namespace

std::size_t size_of(ElementType type) {
  return type == ElementType::f32 ? sizeof(float) : sizeof(std::int32_t);
}

const Tensor& SafetensorsView::find(const std::string& name,
                                    const std::filesystem::path& path) const {
  const auto at =
      std::find_if(tensors.begin(), tensors.end(), [&](const Tensor& t) { return t.name == name; });
  if (at == tensors.end()) refuse(path, "the array '" + name + "' is missing");
  return *at;
}

std::string safetensors_header(const std::map<std::string, std::string>& metadata,
                               const std::vector<Tensor>& tensors) {
  nlohmann::ordered_json header;
  header["__metadata__"] = metadata;
  std::size_t offset = 0;
  for (const auto& tensor : tensors) {
    const std::size_t end = std::accumulate(tensor.shape.begin(), tensor.shape.end(),
                                            size_of(tensor.type), std::multiplies<>()) +
                            offset;
    header[tensor.name] = {
        {"dtype", name_of(tensor.type)}, {"shape", tensor.shape}, {"data_offsets", {offset, end}}};
    offset = end;
  }
  std::string text = header.dump();
  while ((kPrefixBytes + text.size()) % kAlignment != 0) text.push_back(' ');
  const std::uint64_t size = text.size();
  std::string prefix(kPrefixBytes, '\0');
  std::memcpy(prefix.data(), &size, kPrefixBytes);
  return prefix + text;
}

SafetensorsView parse_safetensors(std::span<const std::byte> file,
                                  const std::filesystem::path& path) {
  const auto size = header_size(file, path);
  const std::string text(reinterpret_cast<const char*>(file.data()) + kPrefixBytes, size);
  const json header = parse_header(text, path);
  if (!header.is_object()) refuse(path, "the header is not an object");
  if (header.size() > kMaxTensors) refuse(path, "the header lists too many arrays");
  const auto data = file.subspan(kPrefixBytes + size);
  SafetensorsView view;
  for (const auto& [name, entry] : header.items()) {
    if (name != "__metadata__") {
      view.tensors.push_back(tensor_from(name, entry, data, path));
      continue;
    }
    try {
      view.metadata = entry.get<std::map<std::string, std::string>>();
    } catch (const json::exception&) {
      refuse(path, "the metadata is damaged");
    }
  }
  check_contiguous(view, data, path);
  return view;
}

std::string metadata_checksum(const std::map<std::string, std::string>& metadata) {
  std::string all;
  for (const auto& [key, value] : metadata) {
    if (key == kMetadataChecksum) continue;
    for (const auto& text : {key, value}) {
      all += text;
      all += '\0';
    }
  }
  return checksum(std::as_bytes(std::span(all)));
}

}  // namespace sparse_mocap
