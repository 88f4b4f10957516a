// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/mapping_file.hpp"

#include <gtest/gtest.h>

#include "formats/format_test_support.hpp"
#include "retargeting/synthetic_body.hpp"
#include "sparse_mocap/base/files.hpp"

namespace sparse_mocap {
namespace {

using testing::contains;
using testing::error_of;
using testing::TemporaryFolder;
using testing::walk;

TEST(MappingFile, SurvivesARoundTripAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const Motion motion = walk(testing::t_pose);
  const JointNames names = mapped_joint_names(motion.skeleton, map_skeleton(motion));
  EXPECT_EQ(names.at("lfemur"), "LeftUpLeg");
  write_mapping(folder / "mapping.json", names);
  EXPECT_EQ(read_mapping(folder / "mapping.json"), names);
  EXPECT_TRUE(contains(read_file(folder / "mapping.json", 1 << 20), "\"format_version\": 1,\n"));
  const auto unversioned =
      folder.write("old.json", R"({"format": "sparse_mocap_mapping", "joints": {"head": "Head"}})");
  EXPECT_EQ(read_mapping(unversioned), (JointNames{{"head", "Head"}}));
  const auto error = [&](const std::string& text) {
    const auto path = folder.write("bad.json", text);
    return error_of([&] { read_mapping(path); });
  };
  const std::string begin = R"({"format": "sparse_mocap_mapping", )";
  EXPECT_TRUE(contains(error("{"), "is not JSON"));
  EXPECT_TRUE(contains(error("{}"), "is not a mapping"));
  EXPECT_TRUE(contains(error("[]"), "is not a mapping"));
  EXPECT_TRUE(contains(error(begin + R"("joint": {}})"), "unknown key 'joint'"));
  EXPECT_TRUE(contains(error(begin + R"("format_version": 2, "joints": {}})"),
                       "of format version 2, and this program reads version 1; update"));
  EXPECT_TRUE(contains(error(begin + R"("format_version": "1", "joints": {}})"),
                       "of format version \"1\", and this"));
  EXPECT_TRUE(contains(error(begin + R"("joints": {"lfemur": 3}})"), "must be an object"));
  EXPECT_TRUE(contains(error(begin + R"("joints": {"lfemor": "a"}})"), "nearest is 'lfemur'"));
  EXPECT_TRUE(
      contains(error(begin + R"("joints": {"head": "a", "head": "b"}})"), "repeats the key"));
}

}  // namespace
}  // namespace sparse_mocap
