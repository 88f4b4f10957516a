// SPDX-License-Identifier: GPL-3.0-or-later
#define NOMINMAX
#define WIN32_LEAN_AND_MEAN
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>

#include <atomic>
#include <string>
#include <system_error>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

constexpr int kMostAttempts = 100;
constexpr DWORD kPause_ms = 10;
constexpr wchar_t kReplaced[] = L".replaced.";  // in the name of a file that gave its own away

std::error_code error_of(DWORD error) { return {static_cast<int>(error), std::system_category()}; }

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
  throw FormatError({path}, what + ": " + error_of(GetLastError()).message());
}

// Deletes those that nobody has mapped any more.
void remove_replaced(const fs::path& path) {
  const std::wstring pattern = path.native() + kReplaced + L"*";
  WIN32_FIND_DATAW entry;
  const HANDLE search = FindFirstFileW(pattern.c_str(), &entry);
  if (search == INVALID_HANDLE_VALUE) return;
  do {
    DeleteFileW((path.parent_path() / entry.cFileName).c_str());
  } while (FindNextFileW(search, &entry) != 0);
  FindClose(search);
}

class MappedBytes : public Bytes {
 public:
  MappedBytes(fs::path path, const void* address, std::size_t size)
      : path_(std::move(path)), address_(address), size_(size) {}
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;
  ~MappedBytes() override {
    UnmapViewOfFile(address_);
    try {
      remove_replaced(path_);
    } catch (const std::exception&) {  // the next one that maps or replaces the file does it
    }
  }
  std::span<const std::byte> view() const override {
    return {static_cast<const std::byte*>(address_), size_};
  }

 private:
  fs::path path_;
  const void* address_;
  std::size_t size_;
};

class Handle {
 public:
  explicit Handle(HANDLE handle) : value(handle) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (is_valid()) CloseHandle(value);
  }
  bool is_valid() const { return value != nullptr && value != INVALID_HANDLE_VALUE; }
  const HANDLE value;
};

bool is_there(const fs::path& path) {
  return GetFileAttributesW(path.c_str()) != INVALID_FILE_ATTRIBUTES;
}

bool rename(const fs::path& from, const fs::path& to, DWORD flags) {
  return MoveFileExW(from.c_str(), to.c_str(), flags | MOVEFILE_WRITE_THROUGH) != 0;
}

// Windows replaces no file that somebody has mapped, but it does rename it.
bool replace_mapped(const fs::path& from, const fs::path& to) {
  static std::atomic<unsigned> counter{0};
  fs::path aside = to;
  aside += kReplaced + std::to_wstring(process_id()) + L"." + std::to_wstring(counter++);
  if (!rename(to, aside, 0)) return false;
  if (!rename(from, to, 0)) {
    rename(aside, to, 0);
    return false;
  }
  DeleteFileW(aside.c_str());
  return true;
}

bool may_be_replaced_later(DWORD error, const fs::path& path) {
  if (error != ERROR_ACCESS_DENIED && error != ERROR_SHARING_VIOLATION &&
      error != ERROR_USER_MAPPED_FILE)
    return false;
  const DWORD attributes = GetFileAttributesW(path.c_str());
  return attributes == INVALID_FILE_ATTRIBUTES ||
         (attributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_READONLY)) == 0;
}

}  // namespace

int process_id() { return _getpid(); }

std::FILE* open_file(const fs::path& path) { return _wfopen(path.c_str(), L"rb"); }

std::FILE* create_file(const fs::path& path) {
  const int descriptor =
      _wopen(path.c_str(), _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY | _O_NOINHERIT,
             _S_IREAD | _S_IWRITE);
  return descriptor < 0 ? nullptr : _fdopen(descriptor, "wb");
}

bool sync_file(std::FILE* file) { return _commit(_fileno(file)) == 0; }

// An open file can neither be renamed nor be removed by others.
void close_and_replace(std::FILE* created, const fs::path& from, const fs::path& to) {
  std::fclose(created);
  remove_replaced(to);
  for (int attempt = 1;; ++attempt) {
    if (rename(from, to, MOVEFILE_REPLACE_EXISTING)) return;
    const DWORD error = GetLastError();
    if (!may_be_replaced_later(error, to) || attempt == kMostAttempts)
      throw fs::filesystem_error("cannot rename", from, to, error_of(error));
    if (replace_mapped(from, to)) return;
    Sleep(kPause_ms);  // somebody reads it: an indexer, an antivirus, another program
  }
}

void remove_unless_written(const fs::path& path) { DeleteFileW(path.c_str()); }

// An open file cannot be replaced, so a file beside it is opened for this holder alone. The system
// deletes it when its holder ends, however it ends.
std::shared_ptr<const void> try_lock(const fs::path& path) {
  fs::path beside = path;
  beside += L".lock";
  // While a holder replaces the file, it is not there for a moment.
  const bool exists = is_there(path) || is_there(beside);
  auto file = std::make_shared<const Handle>(
      exists ? CreateFileW(beside.c_str(), GENERIC_WRITE, 0, nullptr, OPEN_ALWAYS,
                           FILE_ATTRIBUTE_HIDDEN | FILE_FLAG_DELETE_ON_CLOSE, nullptr)
             : INVALID_HANDLE_VALUE);
  const DWORD error = file->is_valid() || !exists ? ERROR_SUCCESS : GetLastError();
  const bool is_taken = error == ERROR_SHARING_VIOLATION || error == ERROR_DELETE_PENDING;
  return is_taken ? nullptr : file;
}

void sync_folder(const fs::path&) {}  // MOVEFILE_WRITE_THROUGH did it

std::shared_ptr<const Bytes> map_regular_file(const fs::path& path) {
  // Everybody else may go on to write, rename and delete it.
  constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
  const Handle file(CreateFileW(path.c_str(), GENERIC_READ, kShared, nullptr, OPEN_EXISTING,
                                FILE_ATTRIBUTE_NORMAL, nullptr));
  LARGE_INTEGER size{};
  if (!file.is_valid() || GetFileSizeEx(file.value, &size) == 0) refuse(path, "cannot be read");
  if (size.QuadPart == 0) return own_bytes({});
  const Handle mapping(CreateFileMappingW(file.value, nullptr, PAGE_READONLY, 0, 0, nullptr));
  if (!mapping.is_valid()) refuse(path, "cannot be mapped");
  const void* address = MapViewOfFile(mapping.value, FILE_MAP_READ, 0, 0, 0);
  if (address == nullptr) refuse(path, "cannot be mapped");
  return std::make_shared<MappedBytes>(path, address, static_cast<std::size_t>(size.QuadPart));
}

}  // namespace sparse_mocap
