// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

namespace sparse_mocap {

// Held by whoever reads a file, changes what it read and replaces the file, so that two programs
// (or threads) that do so at once do it one after another. Readers need no lock.
class FileLock {
 public:
  // Waits while another holds the lock of this file, calling `wait` again and again meanwhile;
  // what that throws ends the waiting. Without effect where there is no file, or on a file system
  // that has no locks.
  explicit FileLock(const std::filesystem::path& path, const std::function<void()>& wait = {});
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::shared_ptr<const void> held_;
};

}  // namespace sparse_mocap
