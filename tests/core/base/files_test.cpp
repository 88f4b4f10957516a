// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/base/progress.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::contains;
using testing::error_of;
using testing::TemporaryFolder;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(ReadFile, GivesTheBytesAndKeepsToItsLimit) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  folder.write("file", bytes);
  EXPECT_EQ(read_file(folder / "file", 6), bytes);
  EXPECT_TRUE(contains(error_of([&] { read_file(folder / "file", 5); }),
                       "has 6 bytes, more than the limit of 5"));
  folder.write("empty", "");
  EXPECT_EQ(read_file(folder / "empty", 0), "");
}

TEST(ReadFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(error_of([&] { read_file(folder / "none", 10); }), "no such file"));
  EXPECT_TRUE(contains(error_of([&] { read_file(folder.path(), 10); }), "is a folder"));
#ifndef _WIN32
  EXPECT_TRUE(contains(error_of([&] { read_file("/dev/zero", 10); }), "not a regular file"));
#endif
}

TEST(WriteFileAtomically, ReplacesTheFileByAllPiecesInOrder) {
  const TemporaryFolder folder;
  folder.write("file", "something old and long");
  const std::string a = "one ", b, c = "three";
  const std::vector<std::span<const std::byte>> pieces{
      std::as_bytes(std::span(a)), std::as_bytes(std::span(b)), std::as_bytes(std::span(c))};
  write_file_atomically(folder / "file", pieces);
  EXPECT_EQ(read_file(folder / "file", 100), "one three");
  write_file_atomically(folder / "other", std::string("text"));
  EXPECT_EQ(read_file(folder / "other", 100), "text");
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"file", "other"}));
}

TEST(WriteFileAtomically, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "taken/by a folder");
  EXPECT_THROW(write_file_atomically(folder / "taken", std::string("x")), fs::filesystem_error);
  EXPECT_THROW(write_file_atomically(folder / "none/file", std::string("x")), fs::filesystem_error);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"taken"});
}

TEST(WriteFileAtomically, NamesTheFileThatWasAskedFor) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "taken/by a folder");
  for (const char* name : {"taken", "none/file"}) {
    try {
      write_file_atomically(folder / name, std::string("x"));
      ADD_FAILURE() << name;
    } catch (const fs::filesystem_error& error) {
      EXPECT_EQ(error.path1(), folder / name);
    }
  }
}

TEST(RemoveAbandonedTemporaries, LeavesWhatIsNoneOfThisFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a.smdb.tmp.1.0", "a.smdb.tmp.77.12", "a.smdb", "b.smdb.tmp.1.0",
                           "a.smdb.tmp", "a.smdb.tmp.", "a.smdb.tmp.1.0.bvh", "xa.smdb.tmp.1.0"})
    folder.write(name, "x");
  remove_abandoned_temporaries(folder / "a.smdb");
  EXPECT_EQ(names_in(folder.path()),
            (std::vector<std::string>{"a.smdb", "a.smdb.tmp", "a.smdb.tmp.", "a.smdb.tmp.1.0.bvh",
                                      "b.smdb.tmp.1.0", "xa.smdb.tmp.1.0"}));
  remove_abandoned_temporaries(folder / "no such folder/a.smdb");
}

TEST(MapFile, ShowsTheFileAsItWasWhenOpened) {
  const TemporaryFolder folder;
  const auto path = folder.write("file", "the old content");
  const auto bytes = map_file(path);
  write_file_atomically(path, std::string("new"));
  const auto view = bytes->view();
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(view.data()), view.size()),
            "the old content");
  EXPECT_EQ(map_file(path)->view().size(), 3U);
}

TEST(MapFile, TakesEmptyFilesAndRefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(map_file(folder.write("empty", ""))->view().empty());
  EXPECT_REFUSED(FormatError, "no such file", map_file(folder / "none"));
  EXPECT_REFUSED(FormatError, "is not a regular file", map_file(folder.path()));
  EXPECT_EQ(own_bytes({std::byte{1}, std::byte{2}})->view().size(), 2U);
}

TEST(FormatError, IsOneLineOfPlaceProblemAndRemedy) {
  EXPECT_STREQ(FormatError({"walk.bvh", 57, 12}, "expected 3 numbers", "add one").what(),
               "walk.bvh:57:12: expected 3 numbers; add one");
  EXPECT_STREQ(FormatError({"walk.bvh", 57}, "is odd").what(), "walk.bvh:57: is odd");
  EXPECT_STREQ(FormatError({"walk.bvh"}, "is empty").what(), "walk.bvh: is empty");
  EXPECT_STREQ(FormatError({}, "is lost").what(), "is lost");
  EXPECT_EQ(FormatError({"walk.bvh", 57, 12}, "x").location().line, 57);
}

TEST(Progress, ReportsAndCancelsWhenAskedTo) {
  Progress().report(1, 2, "nobody listens");
  std::string seen;
  const Progress progress([&](std::size_t done, std::size_t total, std::string_view what) {
    seen += std::to_string(done) + "/" + std::to_string(total) + " " + std::string(what) + ";";
    return done < 2;
  });
  progress.report(1, 3, "a");
  EXPECT_THROW(progress.report(2, 3, "b"), Cancelled);
  EXPECT_EQ(seen, "1/3 a;2/3 b;");
}

}  // namespace
}  // namespace sparse_mocap
