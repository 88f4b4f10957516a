// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

class MappedBytes : public Bytes {
 public:
  MappedBytes(void* address, std::size_t size) : address_(address), size_(size) {}
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;
  ~MappedBytes() override { munmap(address_, size_); }
  std::span<const std::byte> view() const override {
    return {static_cast<const std::byte*>(address_), size_};
  }
  void release(std::span<const std::byte> part) const override {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const auto offset = static_cast<std::size_t>(part.data() - view().data());
    const std::size_t begin = (offset + page - 1) / page * page;
    const std::size_t end = (offset + part.size()) / page * page;
    if (end > begin) madvise(static_cast<std::byte*>(address_) + begin, end - begin, MADV_DONTNEED);
  }

 private:
  void* address_;
  std::size_t size_;
};

class Descriptor {
 public:
  explicit Descriptor(const fs::path& path) : value(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value >= 0) close(value);
  }
  const int value;
};

bool lock(int descriptor) { return flock(descriptor, LOCK_EX | LOCK_NB) == 0; }

// Whether the path leads to the file that is open.
bool is_still(int descriptor, const fs::path& path) {
  struct stat opened {
  }, there{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &there) == 0 &&
         opened.st_dev == there.st_dev && opened.st_ino == there.st_ino;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw FormatError({path}, what + ": " + std::generic_category().message(errno));
}

}  // namespace

int process_id() { return getpid(); }

std::FILE* open_file(const fs::path& path) { return std::fopen(path.c_str(), "rb"); }

std::FILE* create_file(const fs::path& path) {
  for (;;) {
    std::FILE* file = std::fopen(path.c_str(), "wbx");
    if (file == nullptr) return nullptr;
    lock(fileno(file));  // the system unlocks it when the writer ends, however it ends
    if (is_still(fileno(file), path)) return file;
    std::fclose(file);  // removed as abandoned just before it was locked
  }
}

bool sync_file(std::FILE* file) { return fsync(fileno(file)) == 0; }

void close_and_replace(std::FILE* created, const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);  // while it is locked still
  std::fclose(created);
  if (error) throw fs::filesystem_error("cannot rename", from, to, error);
}

void remove_unless_written(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return;
  if (lock(file)) unlink(path.c_str());
  close(file);
}

// The lock lies on the file itself; one that was replaced before the lock was there is another
// file, so that one is locked then.
std::shared_ptr<const void> try_lock(const fs::path& path) {
  for (;;) {
    auto file = std::make_shared<const Descriptor>(path);
    if (file->value < 0) return file;
    if (!lock(file->value)) return errno == EWOULDBLOCK ? nullptr : file;
    if (is_still(file->value, path) || !fs::exists(path)) return file;
  }
}

void sync_folder(const fs::path& folder) {
  const Descriptor descriptor(folder);
  if (descriptor.value >= 0) fsync(descriptor.value);
}

std::shared_ptr<const Bytes> map_regular_file(const fs::path& path) {
  const Descriptor file(path);
  struct stat status {};
  if (file.value < 0 || fstat(file.value, &status) != 0) refuse(path, "cannot be read");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return own_bytes({});
  void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.value, 0);
  if (address == MAP_FAILED) refuse(path, "cannot be mapped");
  return std::make_shared<MappedBytes>(address, size);
}

}  // namespace sparse_mocap
