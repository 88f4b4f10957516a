// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/container.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/base/strict_json.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

constexpr char kFormat[] = "format";
constexpr char kFormatVersion[] = "format_version";
constexpr char kChecksums[] = "checksums";

constexpr std::size_t kWorthThreads = 1 << 24;  // bytes

std::string with_article(const ContainerFormat& format) { return std::string("a ") + format.what; }

SafetensorsView parsed(std::span<const std::byte> file, const std::filesystem::path& path,
                       const ContainerFormat& format) {
  try {
    return parse_safetensors(file);
  } catch (const std::invalid_argument& error) {
    throw FormatError({path}, std::string("not a sound ") + format.what + ": " + error.what(),
                      format.remedy);
  }
}

std::string versions_of(const ContainerFormat& format) {
  const std::string newest = std::to_string(format.version);
  return format.oldest == format.version
             ? "version " + newest
             : "versions " + std::to_string(format.oldest) + " to " + newest;
}

// What to do about a file of another version.
std::string remedy_for_version(const std::string& version, const ContainerFormat& format) {
  int number = 0;
  const auto [end, error] =
      std::from_chars(version.data(), version.data() + version.size(), number);
  const bool is_newer =
      error == std::errc() && end == version.data() + version.size() && number > format.version;
  return (is_newer ? "update Sparse Mocap, or " : "") + std::string(format.remedy);
}

}  // namespace

Container::Container(std::span<const std::byte> file, const std::filesystem::path& path,
                     const ContainerFormat& format)
    : path_(path), format_(format), content_(parsed(file, path, format)) {
  check_format();
  check_checksums(nullptr);
}

Container::Container(const Bytes& file, const std::filesystem::path& path,
                     const ContainerFormat& format)
    : path_(path), format_(format), content_(parsed(file.view(), path, format)) {
  check_format();
  check_checksums(&file);
}

const std::string& Container::text(const std::string& key) const {
  const auto at = metadata().find(key);
  if (at == metadata().end()) refuse("'" + key + "' is missing");
  return at->second;
}

const Tensor& Container::tensor(const std::string& name) const {
  const Tensor* found = content_.find(name);
  if (found == nullptr) refuse("the array '" + name + "' is missing");
  return *found;
}

void Container::refuse(const std::string& problem) const {
  throw FormatError({path_}, std::string("not a sound ") + format_.what + ": " + problem,
                    format_.remedy);
}

void Container::check_format() {
  const auto at = metadata().find(kFormat);
  const std::string name = at == metadata().end() ? "" : at->second;
  for (const ContainerFormat& other : {kDatabaseFormat, kModelFormat})
    if (name == other.name && name != format_.name)
      throw FormatError({path_}, "is " + with_article(other) + ", not " + with_article(format_),
                        std::string("name a file that ends in ") + format_.ending);
  if (name != format_.name) refuse("it is a safetensors file of something else");
  const std::string& version = text(kFormatVersion);
  for (version_ = format_.oldest; version_ <= format_.version; ++version_)
    if (version == std::to_string(version_)) return;
  throw FormatError({path_},
                    "is " + with_article(format_) + " of format version " + version +
                        ", and this program reads " + versions_of(format_),
                    remedy_for_version(version, format_));
}

void Container::check_checksums(const Bytes* mapped) {
  if (metadata_checksum(metadata()) != text(kMetadataChecksum))
    refuse("its metadata does not match its checksum");
  try {
    checksums_ = json::parse(text(kChecksums)).get<std::map<std::string, std::string>>();
  } catch (const json::exception&) {
    refuse("its metadata is damaged");
  }
  std::vector<std::pair<const Tensor*, const std::string*>> arrays;
  std::size_t num_bytes = 0;
  for (const auto& [name, sum] : checksums_) {
    arrays.emplace_back(&tensor(name), &sum);
    num_bytes += arrays.back().first->bytes.size();
  }
  const auto is_right = [&](std::size_t i, const std::stop_token&) {
    const auto& [array, sum] = arrays[i];
    const bool matches = checksum(array->bytes) == *sum;
    if (mapped != nullptr) mapped->release(array->bytes);
    return matches;
  };
  const auto take = [&](std::size_t i, bool matches) {
    if (!matches) refuse("the array '" + arrays[i].first->name + "' does not match its checksum");
  };
  if (mapped != nullptr && num_bytes >= kWorthThreads)
    return work_in_order(arrays.size(), 0, is_right, take, [](std::size_t) {});
  for (std::size_t i = 0; i < arrays.size(); ++i) take(i, is_right(i, {}));
}

EncodedContainer::EncodedContainer(const ContainerFormat& format,
                                   std::map<std::string, std::string> metadata,
                                   std::vector<ArrayInPieces> arrays) {
  std::stable_sort(arrays.begin(), arrays.end(), [](const auto& a, const auto& b) {
    return size_of(a.tensor.type) > size_of(b.tensor.type);
  });
  json checksums = json::object();
  std::vector<Tensor> tensors;
  for (const auto& array : arrays) {
    checksums[array.tensor.name] = checksum_of_pieces(array.pieces);
    tensors.push_back(array.tensor);
    pieces_.insert(pieces_.end(), array.pieces.begin(), array.pieces.end());
  }
  metadata[kFormat] = format.name;
  metadata[kFormatVersion] = std::to_string(format.version);
  metadata[kChecksums] = checksums.dump(-1, ' ', false, json::error_handler_t::replace);
  metadata[kMetadataChecksum] = metadata_checksum(metadata);
  header_ = safetensors_header(metadata, tensors);
  pieces_.insert(pieces_.begin(), std::as_bytes(std::span(header_)));
}

std::vector<std::byte> EncodedContainer::bytes() const {
  std::vector<std::byte> file;
  for (const auto piece : pieces_) file.insert(file.end(), piece.begin(), piece.end());
  return file;
}

void EncodedContainer::write(const std::filesystem::path& path) const {
  write_file_atomically(path, pieces_);
}

const std::set<std::string>& container_keys() {
  static const std::set<std::string> keys{kFormat, kFormatVersion, kChecksums, kMetadataChecksum};
  return keys;
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
