// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/files.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>
#include <vector>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_errno(const char* action, const fs::path& path) {
  throw fs::filesystem_error(action, path, std::error_code(errno, std::generic_category()));
}

constexpr char kTemporary[] = ".tmp.";

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  fs::path temporary = path;
  temporary += kTemporary + std::to_string(process_id()) + "." + std::to_string(counter++);
  return temporary;
}

// Whether a file name is one that temporary_beside gives for `target`.
bool is_temporary_of(const fs::path& name, const fs::path& target) {
  using Text = fs::path::string_type;
  fs::path begin = target.filename();
  begin += kTemporary;
  const Text& text = name.native();
  const auto is_number = [](Text::value_type c) { return (c >= '0' && c <= '9') || c == '.'; };
  return text.size() > begin.native().size() && text.starts_with(begin.native()) &&
         std::all_of(text.begin() + static_cast<Text::difference_type>(begin.native().size()),
                     text.end(), is_number);
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : target_(target), path_(temporary_beside(target)) {
    file_ = create_file(path_);
    if (file_ == nullptr) throw_errno("cannot create file", target_);
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
      throw_errno("cannot write", target_);
  }

  void rename_to_target() {
    if (std::fflush(file_) != 0 || !sync_file(file_)) throw_errno("cannot write", target_);
    try {
      close_and_replace(std::exchange(file_, nullptr), path_, target_);
    } catch (const fs::filesystem_error& error) {
      throw fs::filesystem_error("cannot replace", target_, error.code());
    }
    path_.clear();
  }

 private:
  fs::path target_, path_;
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
  temporary.rename_to_target();
  sync_folder(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

void remove_abandoned_temporaries(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ignored;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored))
    if (is_temporary_of(entry->path().filename(), path)) found.push_back(entry->path());
  for (const auto& temporary : found) remove_unless_written(temporary);
}

void write_file_atomically(const fs::path& path, const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  write_file_atomically(path, std::span(&bytes, 1));
}

}  // namespace sparse_mocap
