// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/mapped_file.hpp"

#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {
namespace {

class OwnedBytes : public Bytes {
 public:
  explicit OwnedBytes(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  std::span<const std::byte> view() const override { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

std::shared_ptr<const Bytes> own_bytes(std::vector<std::byte> bytes) {
  return std::make_shared<OwnedBytes>(std::move(bytes));
}

std::shared_ptr<const Bytes> map_file(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw FormatError({path}, "no such file", "check the path");
  if (!std::filesystem::is_regular_file(path)) throw FormatError({path}, "is not a regular file");
  return map_regular_file(path);
}

}  // namespace sparse_mocap
