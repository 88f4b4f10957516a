// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/files.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_errno(const char* action, const fs::path& path) {
  throw fs::filesystem_error(action, path, std::error_code(errno, std::generic_category()));
}

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  fs::path temporary = path;
  temporary += ".tmp." + std::to_string(process_id()) + "." + std::to_string(counter++);
  return temporary;
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : path_(temporary_beside(target)) {
    file_ = create_file(path_);
    if (file_ == nullptr) throw_errno("cannot create file", path_);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (file_ != nullptr) std::fclose(file_);
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }

  void write(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
      throw_errno("cannot write", path_);
  }

  void rename_to(const fs::path& target) {
    if (std::fflush(file_) != 0 || !sync_file(file_)) throw_errno("cannot write", path_);
    std::FILE* closing = file_;
    file_ = nullptr;
    if (std::fclose(closing) != 0) throw_errno("cannot write", path_);
    replace_file(path_, target);
    path_.clear();
  }

 private:
  fs::path path_;
  std::FILE* file_ = nullptr;
};

}  // namespace

std::string read_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) throw FormatError({path}, "no such file", "check the path");
  if (fs::is_directory(status))
    throw FormatError({path}, "is a folder, not a file", "name a file in it");
  if (!fs::is_regular_file(status))
    throw FormatError({path}, "is not a regular file", "name a file");
  const auto size = fs::file_size(path, error);
  if (error) throw FormatError({path}, "cannot be read: " + error.message());
  if (size > max_bytes) {
    throw FormatError({path},
                      "has " + std::to_string(size) + " bytes, more than the limit of " +
                          std::to_string(max_bytes),
                      "raise the limit max_bytes if that is intended");
  }
  std::FILE* file = open_file(path);
  if (file == nullptr) {
    throw FormatError({path},
                      std::string("cannot be read: ") + std::generic_category().message(errno));
  }
  std::string content(size, '\0');
  const std::size_t got = std::fread(content.data(), 1, content.size(), file);
  std::fclose(file);
  if (got != content.size()) throw FormatError({path}, "changed or failed while being read");
  return content;
}

void write_file_atomically(const fs::path& path,
                           std::span<const std::span<const std::byte>> pieces) {
  TemporaryFile temporary(path);
  for (const auto piece : pieces) temporary.write(piece);
  temporary.rename_to(path);
  sync_folder(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

void write_file_atomically(const fs::path& path, const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  write_file_atomically(path, std::span(&bytes, 1));
}

}  // namespace sparse_mocap
