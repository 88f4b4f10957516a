// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the fuzzer runs, on every file of its corpus.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/streams.hpp"

namespace sparse_mocap {
namespace {

TEST(StreamCorpus, HoldsNothingThatParsersStumbleOver) {
  const auto folder =
      std::filesystem::path(SPARSE_MOCAP_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / "streams";
  std::size_t num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(fuzz::try_streams(input), "") << entry.path();
    for (std::size_t size = 0; size < input.size(); size += 7)
      EXPECT_EQ(fuzz::try_streams(input.substr(0, size)), "") << entry.path() << " cut at " << size;
    ++num_files;
  }
  EXPECT_GE(num_files, fuzz::stream_settings().size());
}

}  // namespace
}  // namespace sparse_mocap
