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

struct TypeEntry {
  ElementType type;
  const char* name;
  std::size_t size;
};

constexpr std::array<TypeEntry, 17> kTypes{{{ElementType::boolean, "BOOL", 1},
                                            {ElementType::u8, "U8", 1},
                                            {ElementType::i8, "I8", 1},
                                            {ElementType::f8_e5m2, "F8_E5M2", 1},
                                            {ElementType::f8_e4m3, "F8_E4M3", 1},
                                            {ElementType::f8_e8m0, "F8_E8M0", 1},
                                            {ElementType::u16, "U16", 2},
                                            {ElementType::i16, "I16", 2},
                                            {ElementType::f16, "F16", 2},
                                            {ElementType::bf16, "BF16", 2},
                                            {ElementType::u32, "U32", 4},
                                            {ElementType::i32, "I32", 4},
                                            {ElementType::f32, "F32", 4},
                                            {ElementType::u64, "U64", 8},
                                            {ElementType::i64, "I64", 8},
                                            {ElementType::f64, "F64", 8},
                                            {ElementType::c64, "C64", 8}}};

const TypeEntry& entry_of(ElementType type) {
  return *std::find_if(kTypes.begin(), kTypes.end(),
                       [&](const TypeEntry& entry) { return entry.type == type; });
}

[[noreturn]] void refuse(const std::string& problem) { throw std::invalid_argument(problem); }

ElementType type_named(const std::string& name) {
  const auto at = std::find_if(kTypes.begin(), kTypes.end(),
                               [&](const TypeEntry& entry) { return name == entry.name; });
  if (at == kTypes.end()) refuse("unknown element type '" + name + "'");
  return at->type;
}

json parse_header(const std::string& text) {
  try {
    return parse_json_strictly(text);
  } catch (const std::invalid_argument& error) {
    refuse(std::string("the header ") + error.what());
  }
}

std::size_t product(const std::vector<std::size_t>& shape, std::size_t element) {
  std::size_t total = element;
  for (const std::size_t n : shape) {
    if (n != 0 && total > std::numeric_limits<std::size_t>::max() / n)
      refuse("an array's size overflows");
    total *= n;
  }
  return total;
}

bool is_list_of_counts(const json& value) {
  return value.is_array() && std::all_of(value.begin(), value.end(),
                                         [](const json& n) { return n.is_number_unsigned(); });
}

Tensor tensor_from(const std::string& name, const json& entry, std::span<const std::byte> data) {
  Tensor tensor;
  tensor.name = name;
  std::array<std::size_t, 2> range{};
  try {
    tensor.type = type_named(entry.at("dtype").get<std::string>());
    if (!is_list_of_counts(entry.at("shape"))) refuse("array '" + name + "' has a bad shape");
    tensor.shape = entry.at("shape").get<std::vector<std::size_t>>();
    if (!is_list_of_counts(entry.at("data_offsets")) || entry.at("data_offsets").size() != 2)
      refuse("array '" + name + "' has bad offsets");
    range = entry.at("data_offsets").get<std::array<std::size_t, 2>>();
  } catch (const json::exception&) {
    refuse("the description of array '" + name + "' is damaged");
  }
  if (range[0] > range[1] || range[1] > data.size())
    refuse("array '" + name + "' lies outside the file");
  if (product(tensor.shape, size_of(tensor.type)) != range[1] - range[0])
    refuse("array '" + name + "' has not the size of its shape");
  tensor.bytes = data.subspan(range[0], range[1] - range[0]);
  return tensor;
}

void check_contiguous(SafetensorsView& view, std::span<const std::byte> data) {
  std::stable_sort(view.tensors.begin(), view.tensors.end(), [](const Tensor& a, const Tensor& b) {
    return std::pair(a.bytes.data(), a.bytes.size()) < std::pair(b.bytes.data(), b.bytes.size());
  });
  const std::byte* expected = data.data();
  for (const auto& tensor : view.tensors) {
    if (tensor.bytes.data() != expected) refuse("arrays overlap or leave a hole");
    expected += tensor.bytes.size();
  }
  if (expected != data.data() + data.size()) refuse("bytes follow the last array");
}

std::string dumped(const nlohmann::ordered_json& header) {
  try {
    return header.dump();
  } catch (const json::type_error&) {
    refuse("a name or a text is not UTF-8");
  }
}

std::uint64_t header_size(std::span<const std::byte> file) {
  if (file.size() < kPrefixBytes) refuse("the file is too short");
  std::uint64_t size = 0;
  std::memcpy(&size, file.data(), kPrefixBytes);
  if (size > kMaxHeaderBytes || size > file.size() - kPrefixBytes)
    refuse("the header's length is wrong");
  return size;
}

}  // namespace

const char* name_of(ElementType type) { return entry_of(type).name; }

std::size_t size_of(ElementType type) { return entry_of(type).size; }

const Tensor* SafetensorsView::find(const std::string& name) const {
  const auto at =
      std::find_if(tensors.begin(), tensors.end(), [&](const Tensor& t) { return t.name == name; });
  return at == tensors.end() ? nullptr : &*at;
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
  std::string text = dumped(header);
  while ((kPrefixBytes + text.size()) % kAlignment != 0) text.push_back(' ');
  const std::uint64_t size = text.size();
  std::string prefix(kPrefixBytes, '\0');
  std::memcpy(prefix.data(), &size, kPrefixBytes);
  return prefix + text;
}

SafetensorsView parse_safetensors(std::span<const std::byte> file) {
  const auto size = header_size(file);
  const std::string text(reinterpret_cast<const char*>(file.data()) + kPrefixBytes, size);
  const json header = parse_header(text);
  if (!header.is_object()) refuse("the header is not an object");
  if (header.size() > kMaxTensors) refuse("the header lists too many arrays");
  const auto data = file.subspan(kPrefixBytes + size);
  SafetensorsView view;
  for (const auto& [name, entry] : header.items()) {
    if (name != "__metadata__") {
      view.tensors.push_back(tensor_from(name, entry, data));
      continue;
    }
    try {
      view.metadata = entry.get<std::map<std::string, std::string>>();
    } catch (const json::exception&) {
      refuse("the metadata is damaged");
    }
  }
  check_contiguous(view, data);
  return view;
}

}  // namespace sparse_mocap
