// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/mapped_file.hpp"

#include <cerrno>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#ifndef _WIN32
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/files.hpp"

namespace sparse_mocap {
namespace {

class OwnedBytes : public Bytes {
 public:
  explicit OwnedBytes(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  std::span<const std::byte> view() const override { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

#ifndef _WIN32
class MappedBytes : public Bytes {
 public:
  MappedBytes(void* address, std::size_t size) : address_(address), size_(size) {}
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;
  ~MappedBytes() override {
    if (size_ > 0) munmap(address_, size_);
  }
  std::span<const std::byte> view() const override {
    return {static_cast<const std::byte*>(address_), size_};
  }

 private:
  void* address_;
  std::size_t size_;
};

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : value(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value >= 0) close(value);
  }
  const int value;
};
#endif

}  // namespace

std::shared_ptr<const Bytes> own_bytes(std::vector<std::byte> bytes) {
  return std::make_shared<OwnedBytes>(std::move(bytes));
}

std::shared_ptr<const Bytes> map_file(const std::filesystem::path& path) {
#ifdef _WIN32
  const std::string text = read_file(path, std::numeric_limits<std::size_t>::max());
  const auto bytes = std::as_bytes(std::span(text));
  return own_bytes(std::vector<std::byte>(bytes.begin(), bytes.end()));
#else
  if (!std::filesystem::exists(path)) throw FormatError({path}, "no such file", "check the path");
  if (!std::filesystem::is_regular_file(path)) throw FormatError({path}, "is not a regular file");
  const Descriptor file(path);
  struct stat status {};
  if (file.value < 0 || fstat(file.value, &status) != 0)
    throw FormatError({path},
                      std::string("cannot be read: ") + std::generic_category().message(errno));
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return own_bytes({});
  void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.value, 0);
  if (address == MAP_FAILED)
    throw FormatError({path},
                      std::string("cannot be mapped: ") + std::generic_category().message(errno));
  return std::make_shared<MappedBytes>(address, size);
#endif
}

}  // namespace sparse_mocap
