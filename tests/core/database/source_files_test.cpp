// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/source_files.hpp"

#include <gtest/gtest.h>

#include <set>

#include "formats/format_test_support.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class SourceFiles : public ::testing::Test {
 protected:
  SourceFiles() {
    for (const char* folder : {"a/deep", "b", "c/b"}) fs::create_directories(folder_ / folder);
    for (const char* file : {"a/walk.bvh", "a/deep/run.BVH", "a/deep/x.amc", "a/notes.txt",
                             "b/walk.bvh", "b/hop.bvh", "c/b/hop.bvh"})
      folder_.write(file, file);
  }

  std::vector<std::string> names(const std::vector<std::string>& sources) const {
    std::vector<fs::path> paths;
    for (const auto& source : sources) paths.push_back(folder_ / source);
    std::vector<std::string> out;
    for (const auto& file : find_source_files(paths, {})) out.push_back(file.name);
    return out;
  }

  const TemporaryFolder folder_;
};

using Names = std::vector<std::string>;

TEST_F(SourceFiles, AreNamedByTheirPathInTheFolder) {
  EXPECT_EQ(names({"a"}), (Names{"deep/run.BVH", "deep/x.amc", "walk.bvh"}));
  EXPECT_EQ(names({"a/"}), names({"a"}));
  EXPECT_EQ(names({"a/./deep/.."}), names({"a"}));
  EXPECT_EQ(names({"a/deep/run.BVH", "b/hop.bvh"}), (Names{"run.BVH", "hop.bvh"}));
}

TEST_F(SourceFiles, OccurOnceRelativeToTheOuterFolder) {
  EXPECT_EQ(names({"a", "a/deep", "a/walk.bvh"}), names({"a"}));
  EXPECT_EQ(names({"a/deep", "a"}), names({"a"}));
}

TEST_F(SourceFiles, GetLongerNamesWhereTwoFoldersHaveTheSame) {
  EXPECT_EQ(names({"a", "b"}),
            (Names{"deep/run.BVH", "deep/x.amc", "a/walk.bvh", "hop.bvh", "b/walk.bvh"}));
  const auto absolute = names({"b", "c/b"});  // both folders are called b
  EXPECT_EQ(absolute[0], fs::absolute(folder_ / "b/hop.bvh").generic_string());
  EXPECT_EQ(std::set<std::string>(absolute.begin(), absolute.end()).size(), 3U);
}

TEST_F(SourceFiles, KnowTheirSizeAndWhatTheyHold) {
  const auto files = find_source_files({folder_ / "b"}, {"walk*"});
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].num_bytes, 9U);
  EXPECT_EQ(hash_of_file(files[0].path).size(), 16U);
  EXPECT_NE(hash_of_file(files[0].path), hash_of_file(folder_ / "b/walk.bvh"));
  EXPECT_EQ(hashes_of(files[0].path, {}).skeleton, "");
  EXPECT_REFUSED(FormatError, "there is no .asf in", hashes_of(folder_ / "a/deep/x.amc", {}));
  folder_.write("a/deep/x.asf", "1");
  const SourceHashes before = hashes_of(folder_ / "a/deep/x.amc", {});
  folder_.write("a/deep/x.asf", "2");
  const SourceHashes after = hashes_of(folder_ / "a/deep/x.amc", {});
  EXPECT_EQ(before.file, after.file);
  EXPECT_NE(before.skeleton, after.skeleton);
}

}  // namespace
}  // namespace sparse_mocap
