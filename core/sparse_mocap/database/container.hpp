// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/database/safetensors.hpp"

namespace sparse_mocap {

inline constexpr int kDatabaseFormatVersion = 2;
inline constexpr int kModelFormatVersion = 1;

// A file format of this project that is kept in a safetensors file. The file's metadata say which
// format and version it is and hold an XXH3 checksum of every array, and one of the metadata.
struct ContainerFormat {
  const char* name;  // metadata "format"
  int version;       // metadata "format_version" of files that are written
  int oldest;        // the first version that is read
  const char* what;  // for messages
  const char* ending;
  const char* remedy;  // what to do about a file that cannot be used
};

inline constexpr ContainerFormat kDatabaseFormat{
    "sparse_mocap_database",
    kDatabaseFormatVersion,
    1,
    "motion database",
    ".smdb",
    "build it again with 'sparse-mocap database build'"};
inline constexpr ContainerFormat kModelFormat{"sparse_mocap_model", kModelFormatVersion, 1, "model",
                                              ".smmodel",           "train it again"};

// A file of such a format, its container, format, version and checksums found right.
class Container {
 public:
  // The bytes must outlive it; path is for messages. Throws FormatError.
  Container(std::span<const std::byte> file, const std::filesystem::path& path,
            const ContainerFormat& format);
  // The same, on several threads when the file is large. What was checked is no longer kept in
  // memory, but read again when it is used.
  Container(const Bytes& file, const std::filesystem::path& path, const ContainerFormat& format);

  const std::map<std::string, std::string>& metadata() const { return content_.metadata; }
  const std::vector<Tensor>& tensors() const { return content_.tensors; }
  // Both throw FormatError when there is none.
  const std::string& text(const std::string& key) const;
  const Tensor& tensor(const std::string& name) const;
  int version() const { return version_; }
  // The checksums by array, as the file says them and as they were found.
  const std::map<std::string, std::string>& checksums() const { return checksums_; }
  // False where another program put an array into the file and did not say its checksum.
  bool has_checksum(const std::string& tensor) const { return checksums_.contains(tensor); }

  // Throws FormatError: the file is damaged in this way.
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  void check_format();
  void check_checksums(const Bytes* mapped);

  std::filesystem::path path_;
  ContainerFormat format_;
  SafetensorsView content_;
  int version_ = 0;
  std::map<std::string, std::string> checksums_;
};

// An array to be written, in pieces that lie wherever they are.
struct ArrayInPieces {
  Tensor tensor;  // its bytes are not looked at
  std::vector<std::span<const std::byte>> pieces;
};

// A file to be written, arrays of the largest elements first, so that all are aligned. What the
// arrays view must stay until it is written.
class EncodedContainer {
 public:
  // Puts format, version and checksums into the metadata. Throws std::invalid_argument when a text
  // is not UTF-8.
  EncodedContainer(const ContainerFormat& format, std::map<std::string, std::string> metadata,
                   std::vector<ArrayInPieces> arrays);
  EncodedContainer(const EncodedContainer&) = delete;
  EncodedContainer& operator=(const EncodedContainer&) = delete;

  std::vector<std::byte> bytes() const;
  // Atomically, without a second copy of the arrays. Throws std::filesystem_error.
  void write(const std::filesystem::path& path) const;

 private:
  std::string header_;
  std::vector<std::span<const std::byte>> pieces_;
};

// The metadata that every container has; whoever copies a file's metadata leaves them out.
const std::set<std::string>& container_keys();

// The checksum over all entries but kMetadataChecksum, which holds it.
inline constexpr char kMetadataChecksum[] = "metadata_checksum";
std::string metadata_checksum(const std::map<std::string, std::string>& metadata);

}  // namespace sparse_mocap
