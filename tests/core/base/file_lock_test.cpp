// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/file_lock.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/files.hpp"

namespace sparse_mocap {
namespace {

using testing::TemporaryFolder;

TEST(FileLock, LetsOneAfterAnotherReplaceAFile) {
  const TemporaryFolder folder;
  const auto path = folder.write("count", "0");
  const auto count = [&](int times) {
    for (int i = 0; i < times; ++i) {
      const FileLock lock(path);
      write_file_atomically(path, std::to_string(std::stoi(read_file(path, 10)) + 1));
    }
  };
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) threads.emplace_back(count, 25);
  threads.clear();
  EXPECT_EQ(read_file(path, 10), "100");
}

TEST(FileLock, WaitingCanBeGivenUp) {
  const TemporaryFolder folder;
  const auto path = folder.write("file", "x");
  const FileLock held(path);
  int asked = 0;
  const auto give_up = [&] {
    if (++asked == 3) throw std::runtime_error("enough");
  };
  EXPECT_THROW(FileLock(path, give_up), std::runtime_error);
  EXPECT_EQ(asked, 3);
}

TEST(FileLock, AFileThatIsNotThereNeedsNone) {
  const TemporaryFolder folder;
  const FileLock lock(folder / "none");
  const FileLock again(folder / "none");
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
}

}  // namespace
}  // namespace sparse_mocap
