// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/sidecar.hpp"

#include <gtest/gtest.h>

#include "formats/format_test_support.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

using testing::contains;
using testing::error_of;
using testing::TemporaryFolder;

SourceFile file_named(const std::string& name) { return {"/mocap/" + name, name, 0}; }

class SidecarTable : public ::testing::Test {
 protected:
  Sidecar read(const std::string& text) const {
    return Sidecar::read(folder_.write("metadata.csv", text));
  }
  std::string error(const std::string& text) const {
    return error_of([&] { read(text); });
  }
  // What the table makes of a clip: actor, class, origin, license, with "|" between.
  static std::string described(const Sidecar& table, const std::string& name) {
    Clip clip;
    clip.actor = "a";
    clip.motion_class = "c";
    table.describe(file_named(name), clip);
    return clip.actor + "|" + clip.motion_class + "|" + clip.origin + "|" + clip.license;
  }

  const TemporaryFolder folder_;
};

TEST_F(SidecarTable, NamesFilesByPathNameOrStemInAnyCase) {
  const Sidecar table = read(
      "file,actor\n"
      "Deep/Walk.bvh,path\n"
      "walk.BVH,name\n"
      "run,stem\n");
  EXPECT_EQ(described(table, "deep/walk.bvh"), "path|c||");
  EXPECT_EQ(described(table, "other/walk.bvh"), "name|c||");
  EXPECT_EQ(described(table, "deep/RUN.amc"), "stem|c||");
  EXPECT_EQ(described(table, "walk.amc"), "a|c||");
  Clip clip;
  EXPECT_TRUE(table.describe(file_named("run.bvh"), clip));
  EXPECT_FALSE(table.describe(file_named("jump.bvh"), clip));
}

TEST_F(SidecarTable, KeepsWhatItDoesNotSay) {
  const Sidecar table = read(
      "license, SOURCE ,class,actor,file\r\n"
      "CC0,,,anna,x.bvh\r\n"
      "\r\n"
      "  ,studio, walk ,,deep\\y.bvh\r\n");
  EXPECT_EQ(described(table, "x.bvh"), "anna|c||CC0");
  EXPECT_EQ(described(table, "deep/y.bvh"), "a|walk|studio|");
}

TEST_F(SidecarTable, ReadsQuotesAndAByteOrderMark) {
  const Sidecar table = read(
      "\xEF\xBB\xBF"
      "file,\"license\"\n\"a,b.bvh\",\"CC BY 4.0, \"\"as is\"\"\"\n");
  EXPECT_EQ(described(table, "a,b.bvh"), "a|c||CC BY 4.0, \"as is\"");
}

TEST_F(SidecarTable, SaysWhereItIsWrong) {
  EXPECT_TRUE(
      contains(error("file,actr\n"), "1: :1:6: unknown column \"actr\"; did you mean \"actor\"?"));
  EXPECT_TRUE(contains(error("file,licence\n"), "did you mean \"license\"?"));
  EXPECT_TRUE(contains(error("clip,actor\n"), "1: :1:1: unknown column \"clip\""));
  EXPECT_TRUE(contains(error("actor,class\n"), "1: :1:1: the column \"file\" is missing"));
  EXPECT_TRUE(contains(error("file,actor,File\n"), "1: :1:12: the column \"file\" occurs twice"));
  EXPECT_TRUE(contains(error("file,actor\na,b\nc\n"), "3: :3:1: has 1 fields, the header has 2"));
  EXPECT_TRUE(contains(error("file,actor\na,b,\n"), "2: :2:1: has 3 fields, the header has 2"));
  EXPECT_TRUE(contains(error("file,actor\nx,\"b\n"), "2: :2:3: a quote is not closed"));
  EXPECT_TRUE(contains(error("file,actor\n\"x\"y,b\n"), "2: :2:4: text follows a quoted field"));
  EXPECT_TRUE(contains(error("actor,file\nb,\n"), "2: :2:3: names no file"));
  EXPECT_TRUE(contains(error("actor,file\na,x\nb,y\nc,X\n"),
                       "4: :4:3: \"X\" is described in line 2 already"));
  EXPECT_TRUE(contains(error(""), "is empty"));
  EXPECT_TRUE(contains(error("\n  \n"), "is empty"));
  EXPECT_TRUE(contains(error(std::string("file\0actor", 10)), "NUL"));
  EXPECT_REFUSED(FormatError, "no such file", Sidecar::read(folder_ / "none.csv"));
}

TEST_F(SidecarTable, WarnsOfRowsThatNameNoFile) {
  const Sidecar table = read("file\nx\nghost.bvh\ny.bvh\nDeep/z.bvh\n");
  const auto warnings =
      table.warnings({file_named("x.bvh"), file_named("sub/y.bvh"), file_named("sub/z.bvh")});
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(contains(warnings[0], "metadata.csv:3: no motion file is called \"ghost.bvh\""));
  EXPECT_TRUE(contains(warnings[1], "metadata.csv:5: no motion file is called \"Deep/z.bvh\""));
}

}  // namespace
}  // namespace sparse_mocap
