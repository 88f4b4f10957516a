// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/sections.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/database/model_file.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::contains;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

// A database of two clips, and a section of six bytes.
class Sections : public ::testing::Test {
 protected:
  Sections() {
    fs::create_directories(folder_ / "a");
    for (unsigned seed = 1; seed < 3; ++seed)
      write_bvh(folder_ / "a" / ("anna_walk_" + std::to_string(seed) + ".bvh"),
                swaying_motion(template_skeleton(), seed, 90, 60.0));
    BuildOptions options;
    options.tempo_copies = {};
    build_database({folder_ / "a"}, path_, options);
  }

  Section section_of(const std::string& rows) const {
    return {3, rows, {{"leaf", "64"}}, {{"order", ElementType::i16, {3, 1}, bytes()}}};
  }
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(text_)); }
  std::shared_ptr<const MotionDatabase> opened() const { return MotionDatabase::open(path_); }

  const std::string text_ = "\1\2\3\4\5\6";
  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "motions.smdb";
};

TEST_F(Sections, AreGivenBackUnderTheirName) {
  EXPECT_EQ(opened()->section("index"), nullptr);
  store_section(path_, "index", section_of(""));
  const auto database = opened();
  const Section* index = database->section("index");
  ASSERT_NE(index, nullptr);
  EXPECT_EQ(index->version, 3);
  EXPECT_EQ(index->metadata.at("leaf"), "64");
  EXPECT_TRUE(std::ranges::equal(index->tensor("order", ElementType::i16, 2).bytes, bytes()));
  EXPECT_REFUSED(std::invalid_argument, "no tensor 'order'",
                 index->tensor("order", ElementType::i32, 2));
  EXPECT_REFUSED(std::invalid_argument, "no tensor 'none'",
                 index->tensor("none", ElementType::i16, 2));
  EXPECT_EQ(database->section("calibration"), nullptr);
}

TEST_F(Sections, TakeThePlaceOfTheirNamesakesAndLeaveAllElse) {
  const auto before = encode_database(database_content(*opened()));
  const std::string hash = opened()->rows_hash();
  store_section(path_, "index", section_of(hash));
  store_section(path_, "calibration", section_of(""));
  Section other = section_of("");
  other.tensors[0].name = "another";
  store_section(path_, "index", other);
  EXPECT_EQ(opened()->section("index")->tensors.size(), 1U);
  EXPECT_EQ(opened()->section("index")->tensors[0].name, "another");
  EXPECT_NE(opened()->section("calibration"), nullptr);
  EXPECT_EQ(opened()->rows_hash(), hash);
  change_database(path_, [](const MotionDatabase&, SafetensorsView& content) {
    remove_section(content, "index");
    remove_section(content, "calibration");
  });
  EXPECT_EQ(encode_database(database_content(*opened())), before);
}

// An index of rows that are no longer there would lead to others.
TEST_F(Sections, GoWithTheRowsThatTheyWereMadeFrom) {
  store_section(path_, "index", section_of(opened()->rows_hash()));
  store_section(path_, "note", section_of(""));
  EXPECT_NE(opened()->section("index"), nullptr);
  add_to_database(path_, {folder_ / "a"}, path_, ImportOptions());  // all of it is there already
  EXPECT_NE(opened()->section("index"), nullptr);
  drop_from_database(path_, {"anna_walk_2.bvh"}, path_);
  EXPECT_EQ(opened()->section("index"), nullptr);
  EXPECT_NE(opened()->section("note"), nullptr);
  EXPECT_FALSE(contains(opened()->further().metadata.at("sections"), "index"));
  // Also where another program changed the rows and left the section.
  store_section(path_, "index", section_of("0123456789abcdef"));
  EXPECT_EQ(opened()->section("index"), nullptr);
}

TEST_F(Sections, RefuseNamesAndListsThatAreNone) {
  EXPECT_REFUSED(std::invalid_argument, "name must be of a-z",
                 store_section(path_, "In dex", section_of("")));
  for (const char* list : {"[]", "{", R"({"index":1})", R"({"In dex":{}})", R"({"index":{}})",
                           R"({"index":{"version":1,"rows":5,"metadata":{}}})"}) {
    DatabaseContent content = database_content(*opened());
    content.further.metadata[kSectionsKey] = list;
    EXPECT_REFUSED(std::invalid_argument, "the list of its sections is damaged",
                   encode_database(content));
  }
}

}  // namespace
}  // namespace sparse_mocap
