// SPDX-License-Identifier: GPL-3.0-or-later
//
// The corpus of the fuzzers, and every cut of a good file, through what the fuzzers run.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "fuzz/targets.hpp"
#include "sparse_mocap/base/files.hpp"

namespace sparse_mocap::fuzz {
namespace {

struct Format {
  const char* name;
  const char* good_file;
  std::function<std::string(std::string_view)> target;
};

void PrintTo(const Format& format, std::ostream* out) { *out << format.name; }

std::filesystem::path corpus_of(const Format& format) {
  return std::filesystem::path(SPARSE_MOCAP_SOURCE_DIR) / "tests/fuzz/corpus" / format.name;
}

class Corpus : public ::testing::TestWithParam<Format> {};

TEST_P(Corpus, EveryFileIsRefusedOrReadSoundly) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus_of(GetParam()))) {
    EXPECT_EQ(GetParam().target(read_file(entry.path(), 1 << 20)), "") << entry.path();
    ++count;
  }
  EXPECT_GE(count, 100);
}

TEST_P(Corpus, EveryCutIsRefusedOrReadSoundly) {
  const auto whole = read_file(corpus_of(GetParam()) / GetParam().good_file, 1 << 20);
  for (std::size_t length = 0; length <= whole.size(); ++length)
    EXPECT_EQ(GetParam().target(whole.substr(0, length)), "") << length;
}

INSTANTIATE_TEST_SUITE_P(Formats, Corpus,
                         ::testing::Values(Format{"bvh", "whole.bvh", try_bvh},
                                           Format{"acclaim", "whole.acclaim", try_acclaim},
                                           Format{"database", "second_whole.smdb", try_database},
                                           Format{"model", "whole.smmodel", try_model}),
                         [](const auto& format) { return std::string(format.param.name); });

}  // namespace
}  // namespace sparse_mocap::fuzz
