// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace sparse_mocap {

// Read-only bytes that stay where they are for as long as somebody holds them: a file mapped into
// memory, or a buffer.
class Bytes {
 public:
  virtual ~Bytes() = default;
  virtual std::span<const std::byte> view() const = 0;
  // Says that a part of view() is not needed for a while: of a mapped file it need not stay in
  // memory then, and is read again when it is used.
  virtual void release(std::span<const std::byte>) const {}
};

std::shared_ptr<const Bytes> own_bytes(std::vector<std::byte> bytes);

// Maps the file. One that is replaced by rename keeps its old content here. Throws FormatError when
// it is missing, a folder or unreadable.
std::shared_ptr<const Bytes> map_file(const std::filesystem::path& path);

}  // namespace sparse_mocap
