// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/file_lock.hpp"

#include <chrono>
#include <thread>

#include "sparse_mocap/base/system_files.hpp"

namespace sparse_mocap {

FileLock::FileLock(const std::filesystem::path& path, const std::function<void()>& wait) {
  constexpr std::chrono::milliseconds kBetweenTries{50};
  while ((held_ = try_lock(path)) == nullptr) {
    if (wait) wait();
    std::this_thread::sleep_for(kBetweenTries);
  }
}

}  // namespace sparse_mocap
