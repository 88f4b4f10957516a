// SPDX-License-Identifier: GPL-3.0-or-later
//
// Databases that are built by several threads, added to, and dropped from.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/motion_database.hpp"
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

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Folders a (4 clips) and b (3 clips, one of a smaller body).
class EditDatabase : public ::testing::Test {
 protected:
  EditDatabase() {
    fs::create_directories(folder_ / "a/deep");
    fs::create_directories(folder_ / "b");
    StandardBones bones = template_bones();
    for (auto& bone : bones) bone *= 0.8;
    write("a/anna_walk_1.bvh", 1);
    write("a/anna_walk_2.bvh", 2);
    write("a/deep/anna_hop_1.bvh", 3);
    write("a/deep/anna_hop_2.bvh", 4);
    write("b/bert_walk_1.bvh", 5);
    write("b/bert_walk_2.bvh", 6);
    write_bvh(folder_ / "b/carl_walk_1.bvh",
              swaying_motion(make_standard_skeleton(bones), 7, 130, 60.0));
    options_.add_mirrored = true;
    options_.tempo_copies = {1.25};
  }

  void write(const std::string& name, unsigned seed, int frames = 120) const {
    write_bvh(folder_ / name, swaying_motion(template_skeleton(), seed, frames, 60.0));
  }
  fs::path build(const std::vector<std::string>& folders, const std::string& name) const {
    std::vector<fs::path> sources;
    for (const auto& folder : folders) sources.push_back(folder_ / folder);
    build_database(sources, folder_ / name, options_);
    return folder_ / name;
  }
  BuildReport add(const fs::path& database, const std::string& folder) const {
    return add_to_database(database, {folder_ / folder}, database, ImportOptions());
  }
  // Whether clip ca of a and cb of b have the same rows in every array, bit for bit.
  static bool same_rows(const MotionDatabase& a, std::size_t ca, const MotionDatabase& b,
                        std::size_t cb) {
    const Clip &x = a.clips()[ca], &y = b.clips()[cb];
    const auto same = [&](const auto& left, const auto& right) {
      return x.num_frames() == y.num_frames() &&
             left.middleRows(x.begin, x.num_frames()) == right.middleRows(y.begin, y.num_frames());
    };
    const auto scaled = [&](const ScaledRows& left, const ScaledRows& right) {
      return same(left.values(), right.values()) && left.scale(x.begin) == right.scale(y.begin);
    };
    bool are_same = scaled(a.angles(), b.angles()) && scaled(a.positions(), b.positions()) &&
                    same(a.root_motion(), b.root_motion()) && same(a.contacts(), b.contacts());
    for (std::size_t s = 0; s < a.site_names().size(); ++s)
      are_same = are_same &&
                 scaled(a.site(s).specific_force_pivot, b.site(s).specific_force_pivot) &&
                 scaled(a.site(s).specific_force_end, b.site(s).specific_force_end) &&
                 scaled(a.site(s).angular_velocity, b.site(s).angular_velocity) &&
                 scaled(a.site(s).gravity_direction, b.site(s).gravity_direction);
    return are_same;
  }
  static std::vector<std::string> sources_of(const MotionDatabase& database) {
    std::vector<std::string> sources;
    for (const Clip& clip : database.clips())
      if (!clip.is_copy()) sources.push_back(clip.source);
    return sources;
  }

  const TemporaryFolder folder_;
  BuildOptions options_;
};

TEST_F(EditDatabase, AnyNumberOfThreadsBuildsTheSameFile) {
  folder_.write("a/broken.bvh", "HIERARCHY\n");
  fs::copy(folder_ / "a/anna_walk_1.bvh", folder_ / "a/copy.bvh");
  options_.num_threads = 1;
  const std::string one = content(build({"a", "b"}, "1.smdb"));
  for (const int threads : {0, 2, 4, 16}) {
    options_.num_threads = threads;
    EXPECT_EQ(content(build({"a", "b"}, "n.smdb")), one) << threads << " threads";
  }
  options_.num_threads = -1;
  EXPECT_REFUSED(ConfigError, "the number of threads", build({"a"}, "n.smdb"));
}

TEST_F(EditDatabase, StrictNamesTheFirstBadFileWhicheverThreadMeetsIt) {
  for (const char* name : {"a/anna_x.bvh", "a/deep/broken.bvh", "b/a.bvh"})
    folder_.write(name, "HIERARCHY\n");
  options_.is_strict = true;
  options_.num_threads = 4;
  for (int repeat = 0; repeat < 10; ++repeat) {
    const auto error = testing::error_of([&] { build({"a", "b"}, "n.smdb"); });
    EXPECT_TRUE(error.size() > 3);
    try {
      build({"a", "b"}, "n.smdb");
    } catch (const FormatError& caught) {
      EXPECT_EQ(caught.location().path.filename(), "anna_x.bvh");
    }
  }
  EXPECT_FALSE(fs::exists(folder_ / "n.smdb"));
}

TEST_F(EditDatabase, TellsHowFarItIs) {
  std::uint64_t size = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "b")) size += entry.file_size();
  std::vector<ProgressReport> reports;
  build_database({folder_ / "b"}, folder_ / "b.smdb", options_,
                 Progress([&](const ProgressReport& report) {
                   reports.push_back(report);
                   return true;
                 }));
  ASSERT_GE(reports.size(), 6U);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    EXPECT_EQ(reports[i].num_bytes, 2 * size);
    EXPECT_EQ(reports[i].num_files, 3U);
    EXPECT_EQ(reports[i].total, 6U);
    EXPECT_GE(reports[i].bytes, reports[i > 0 ? i - 1 : 0].bytes);
  }
  EXPECT_EQ(reports.front().bytes, 0U);
  EXPECT_EQ(reports.back().files, 2U);
  EXPECT_EQ(reports.back().frames, 240U);
  EXPECT_EQ(reports.back().done, 5U);
}

TEST_F(EditDatabase, AddingKeepsWhatIsThereBitForBit) {
  const auto before = MotionDatabase::open(build({"a"}, "a.smdb"));
  const BuildReport report = add(folder_ / "a.smdb", "b");
  EXPECT_EQ(report.num_files, 3);
  EXPECT_EQ(report.num_known, 0);
  const auto after = MotionDatabase::open(folder_ / "a.smdb");
  EXPECT_EQ(report.num_clips, static_cast<int>(after->clips().size()));
  EXPECT_EQ(report.num_frames, after->num_frames());
  EXPECT_EQ(bones_of(after->skeleton()), bones_of(before->skeleton()));
  ASSERT_EQ(before->clips().size(), 16U);  // mirrored and faster copies of four
  ASSERT_EQ(after->clips().size(), 28U);
  for (std::size_t c = 0; c < 16; ++c) EXPECT_TRUE(same_rows(*before, c, *after, c)) << c;
  EXPECT_EQ(sources_of(*after),
            (std::vector<std::string>{"anna_walk_1.bvh", "anna_walk_2.bvh", "deep/anna_hop_1.bvh",
                                      "deep/anna_hop_2.bvh", "bert_walk_1.bvh", "bert_walk_2.bvh",
                                      "carl_walk_1.bvh"}));
}

// The database's skeleton is that of all its bodies; with one body for all, adding is building.
TEST_F(EditDatabase, AddedClipsAreThoseOfOneBuild) {
  fs::remove(folder_ / "b/carl_walk_1.bvh");
  const auto whole = MotionDatabase::open(build({"a", "b"}, "whole.smdb"));
  build({"a"}, "a.smdb");
  add(folder_ / "a.smdb", "b");
  const auto parts = MotionDatabase::open(folder_ / "a.smdb");
  ASSERT_EQ(parts->clips().size(), whole->clips().size());
  for (std::size_t c = 0; c < whole->clips().size(); ++c) {
    EXPECT_EQ(parts->clips()[c].name, whole->clips()[c].name);
    EXPECT_EQ(parts->clips()[c].num_frames(), whole->clips()[c].num_frames());
    const auto difference = parts->positions().row(whole->clips()[c].begin) -
                            whole->positions().row(whole->clips()[c].begin);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-4F);
  }
}

TEST_F(EditDatabase, DroppingWhatWasAddedGivesTheOldFileBack) {
  const std::string before = content(build({"a"}, "a.smdb"));
  add(folder_ / "a.smdb", "b");
  EXPECT_NE(content(folder_ / "a.smdb"), before);
  EXPECT_EQ(drop_from_database(folder_ / "a.smdb", {"BERT_*", "carl_walk_1.bvh"},
                               folder_ / "dropped.smdb"),
            12);
  EXPECT_EQ(content(folder_ / "dropped.smdb"), before);
}

TEST_F(EditDatabase, DroppingRefusesWhatCannotBeMeant) {
  const std::string before = content(build({"a"}, "a.smdb"));
  const auto drop = [&](const std::vector<std::string>& patterns) {
    return testing::error_of(
        [&] { drop_from_database(folder_ / "a.smdb", patterns, folder_ / "a.smdb"); });
  };
  EXPECT_TRUE(contains(drop({"anna_hop*", "nobody*"}), "no clip matches 'nobody*'"));
  EXPECT_TRUE(contains(drop({"*"}), "every clip would be dropped"));
  EXPECT_EQ(content(folder_ / "a.smdb"), before);
  EXPECT_EQ(drop({"deep/*"}), "");
  EXPECT_EQ(MotionDatabase::open(folder_ / "a.smdb")->clips().size(), 8U);
}

TEST_F(EditDatabase, AddingAgainReadsNothing) {
  const std::string before = content(build({"a"}, "a.smdb"));
  std::set<std::string> asked;
  const BuildReport report =
      add_to_database(folder_ / "a.smdb", {folder_ / "a"}, folder_ / "a.smdb", ImportOptions());
  EXPECT_EQ(report.num_files, 0);
  EXPECT_EQ(report.num_known, 4);
  EXPECT_EQ(report.source_frames, 0U);
  EXPECT_EQ(content(folder_ / "a.smdb"), before);
  // Files of another name with the same content are in as well.
  fs::copy(folder_ / "a/anna_walk_1.bvh", folder_ / "b/other.bvh");
  EXPECT_EQ(add(folder_ / "a.smdb", "b").num_known, 1);
}

TEST_F(EditDatabase, AFileThatChangedTakesThePlaceOfItsOldClips) {
  build({"a"}, "a.smdb");
  const auto before = MotionDatabase::open(folder_ / "a.smdb");
  write("a/anna_walk_2.bvh", 20, 90);
  const BuildReport report = add(folder_ / "a.smdb", "a");
  EXPECT_EQ(report.num_known, 3);
  EXPECT_EQ(report.num_files, 1);
  EXPECT_EQ(report.num_replaced, 1);
  const auto after = MotionDatabase::open(folder_ / "a.smdb");
  EXPECT_EQ(after->clips().size(), before->clips().size());
  EXPECT_EQ(sources_of(*after),
            (std::vector<std::string>{"anna_walk_1.bvh", "deep/anna_hop_1.bvh",
                                      "deep/anna_hop_2.bvh", "anna_walk_2.bvh"}));
  EXPECT_EQ(after->clips().back().source_frames, 90);
  EXPECT_TRUE(same_rows(*before, 0, *after, 0));
  EXPECT_TRUE(same_rows(*before, 8, *after, 4));

  folder_.write("a/anna_walk_2.bvh", "HIERARCHY\n");  // broken: what it was stays
  const BuildReport broken = add(folder_ / "a.smdb", "a");
  EXPECT_EQ(broken.skipped.size(), 1U);
  EXPECT_EQ(sources_of(*MotionDatabase::open(folder_ / "a.smdb")), sources_of(*after));
}

TEST_F(EditDatabase, ChangingKeepsTheOldFileWhenItFails) {
  const std::string before = content(build({"a"}, "a.smdb"));
  const Progress stop([](std::size_t done, std::size_t, std::string_view) { return done < 4; });
  EXPECT_THROW(add_to_database(folder_ / "a.smdb", {folder_ / "b"}, folder_ / "a.smdb", {}, stop),
               Cancelled);
  fs::create_directories(folder_ / "bad");
  folder_.write("bad/x.bvh", "HIERARCHY\n");
  EXPECT_REFUSED(FormatError, "none of 1 motion files can be used", add(folder_ / "a.smdb", "bad"));
  EXPECT_REFUSED(FormatError, "no such file", add(folder_ / "none.smdb", "b"));
  EXPECT_EQ(content(folder_ / "a.smdb"), before);
}

TEST_F(EditDatabase, LeavesDuplicatesOutAndSaysOfWhat) {
  fs::copy(folder_ / "a/anna_walk_1.bvh", folder_ / "b/the_same_file.bvh");
  const Motion slower = resampled(read_bvh(folder_ / "a/anna_walk_2.bvh").motion, 50.0);
  write_bvh(folder_ / "b/the_same_motion.bvh", slower);
  const auto told = [&](const BuildReport& report) {
    std::string all;
    for (const auto& one : report.duplicates)
      all += one.reason.substr(one.reason.rfind('/')) + "\n";
    return all;
  };
  const auto reasons =
      "/the_same_file.bvh: the same file as anna_walk_1.bvh\n"
      "/the_same_motion.bvh: the same motion as anna_walk_2.bvh\n";
  const BuildReport report =
      build_database({folder_ / "a", folder_ / "b"}, folder_ / "x.smdb", options_);
  EXPECT_EQ(told(report), reasons);
  EXPECT_EQ(report.num_files, 7);
  const auto database = MotionDatabase::open(folder_ / "x.smdb");
  EXPECT_EQ(
      database->sources().duplicates,
      (std::vector<LeftOut>{
          {"the_same_file.bvh", "the_same_file.bvh: the same file as anna_walk_1.bvh"},
          {"the_same_motion.bvh", "the_same_motion.bvh: the same motion as anna_walk_2.bvh"}}));

  build({"a"}, "a.smdb");
  const BuildReport added = add(folder_ / "a.smdb", "b");
  EXPECT_EQ(added.num_known, 1);
  EXPECT_EQ(added.num_files, 3);
  EXPECT_EQ(told(added), "/the_same_motion.bvh: the same motion as anna_walk_2.bvh\n");

  options_.keep_duplicates = true;
  EXPECT_EQ(build_database({folder_ / "a", folder_ / "b"}, folder_ / "x.smdb", options_).num_files,
            9);
}

TEST_F(EditDatabase, RemembersWhereItsClipsComeFrom) {
  folder_.write("a/broken.bvh", "HIERARCHY\n");
  options_.labels = {{folder_ / "a/anna_walk_1.bvh", {"Anna B.", "", "", "CC0"}},
                     {folder_ / "a/deep/anna_hop_1.bvh", {"", "", "", "private"}}};
  options_.label_warnings = {"no motion file is called \"nobody.bvh\""};
  const BuildReport report =
      build_database({folder_ / "a", folder_ / "b"}, folder_ / "x.smdb", options_);
  EXPECT_EQ(report.warnings, options_.label_warnings);
  EXPECT_EQ(report.source_frames, 6U * 120U + 130U);
  const auto database = MotionDatabase::open(folder_ / "x.smdb");
  const Clip& walk = database->clips()[0];
  EXPECT_EQ(walk.actor, "Anna B.");
  EXPECT_EQ(walk.license, "CC0");
  EXPECT_EQ(walk.motion_class, "walk");
  EXPECT_EQ(walk.source_frames, 120);
  EXPECT_NEAR(walk.source_rate_hz, 60.0, 1e-3);
  for (const Clip& clip : database->clips()) {
    EXPECT_EQ(clip.license, clip.source == walk.source             ? "CC0"
                            : clip.source == "deep/anna_hop_1.bvh" ? "private"
                                                                   : "");
    EXPECT_EQ(clip.skeleton, walk.skeleton);
  }
  const SourceRecord& sources = database->sources();
  ASSERT_EQ(sources.skeletons.size(), 1U);
  EXPECT_EQ(sources.skeletons[0].id, walk.skeleton);
  EXPECT_EQ(sources.skeletons[0].num_joints, kNumStandardJoints);
  EXPECT_EQ(sources.skeletons[0].joints.at("ltibia"), "ltibia");
  EXPECT_EQ(sources.skeletons[0].unit_scale, 1.0);
  ASSERT_EQ(sources.skipped.size(), 1U);
  EXPECT_EQ(sources.skipped[0].source, "broken.bvh");
  EXPECT_TRUE(sources.skipped[0].reason.starts_with("broken.bvh:")) << sources.skipped[0].reason;

  // Labels that change later are taken over without reading the files again.
  ImportOptions options;
  options.labels = {{folder_ / "a/anna_walk_1.bvh", {"", "stroll", "", ""}}};
  EXPECT_EQ(add_to_database(folder_ / "x.smdb", {folder_ / "b", folder_ / "a"}, folder_ / "x.smdb",
                            options)
                .num_known,
            7);
  EXPECT_EQ(MotionDatabase::open(folder_ / "x.smdb")->clips()[3].motion_class, "stroll");
}

}  // namespace
}  // namespace sparse_mocap
