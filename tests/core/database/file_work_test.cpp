// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/file_work.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

// A folder with two bodies, a copy of one file, and a file that is cut off.
class FileWork : public ::testing::Test {
 protected:
  FileWork() {
    std::filesystem::create_directories(folder_ / "in");
    std::filesystem::create_directories(folder_ / "mappings");
    write_bvh(folder_ / "in/anna_walk.bvh", swaying_motion(template_skeleton(), 1, 121, 60.0));
    write_bvh(folder_ / "in/ben_turn.bvh", swaying_motion(template_skeleton(), 2, 90, 60.0));
    write_bvh(folder_ / "in/ben_turn_again.bvh", swaying_motion(template_skeleton(), 2, 90, 60.0));
    folder_.write("in/broken.bvh", "HIERARCHY\nROOT hips\n{\nOFFSET 1 2\n");
    options_.add_mirrored = true;
    options_.labels[folder_ / "in/anna_walk.bvh"] = {"Anna", "walking", "", "CC0", 30.0};
  }

  std::string database(const char* name) {
    const BuildReport report = build_database({folder_ / "in"}, folder_ / name, options_);
    skipped_ = report.skipped.front().reason;
    warnings_ = report.warnings;
    const std::string path = (folder_ / name).string();
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const TemporaryFolder folder_;
  BuildOptions options_;
  std::string skipped_;
  std::vector<std::string> warnings_;
};

TEST_F(FileWork, BuildsTheSameDatabaseWhenOthersReadTheFiles) {
  const std::string here = database("here.smdb");
  const std::string skipped = skipped_;
  const auto warnings = warnings_;
  int num_requests = 0, num_waited = 0;
  options_.remote = [&](std::vector<std::string> requests) -> NextAnswer {
    num_requests += static_cast<int>(requests.size());
    return [&num_waited, requests, next = std::size_t{0}]() mutable -> std::optional<std::string> {
      if (++num_waited % 3 == 0) return std::nullopt;
      return answer_to(requests.at(next++), {});
    };
  };
  EXPECT_EQ(database("there.smdb"), here);
  EXPECT_EQ(skipped_, skipped);
  EXPECT_NE(skipped.find("broken.bvh:5"), std::string::npos) << skipped;
  EXPECT_EQ(warnings_, warnings);
  EXPECT_EQ(num_requests, 4 + 2);
  EXPECT_GT(num_waited, num_requests);
}

TEST_F(FileWork, SendsMappingsByHandAlong) {
  options_.mapping.by_hand = {{"lfemur", "no such joint"}};
  const Skeleton rig = template_skeleton();
  write_mapping(remembered_mapping_path(folder_ / "mappings", rig), {{"head", "lowerneck"}});
  options_.mapping.remembered = folder_ / "mappings";
  const std::string here = database("here.smdb");
  options_.remote = [](std::vector<std::string> requests) -> NextAnswer {
    return [requests, next = std::size_t{0}]() mutable -> std::optional<std::string> {
      return answer_to(requests.at(next++), {});
    };
  };
  EXPECT_EQ(database("there.smdb"), here);
  options_.mapping.remembered.clear();
  EXPECT_NE(database("unmapped.smdb"), here);
}

TEST_F(FileWork, RefusesWhatIsNoMessage) {
  for (const std::string& bytes : {std::string(), std::string("hello"), std::string("\x81\xA1"),
                                   std::string("\x81\xA6result\x80")}) {
    EXPECT_THROW(answer_to(bytes, {}), std::invalid_argument);
    EXPECT_THROW(decoded_survey(bytes), std::invalid_argument);
    EXPECT_THROW(decoded_import(bytes), std::invalid_argument);
  }
}

TEST_F(FileWork, RefusesAnswersThatAreCutShort) {
  SurveyRequest survey{{folder_ / "in/anna_walk.bvh", "anna_walk.bvh", 1}, {}, {}};
  ImportRequest request{survey, {"1", ""}, template_bones(), {}, false};
  const std::string answer = answer_to(encoded(request), {});
  EXPECT_TRUE(std::holds_alternative<ImportedFile>(decoded_import(answer)));
  for (std::size_t length = 0; length < answer.size(); length += 997)
    EXPECT_THROW(decoded_import(answer.substr(0, length)), std::invalid_argument) << length;
}

}  // namespace
}  // namespace sparse_mocap
