// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/database/database_rows.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/source_files.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::contains;
using testing::Random;
using testing::resting_motion;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

// Three clips of one body in two folders, and a file that is none.
class BuildDatabase : public ::testing::Test {
 protected:
  BuildDatabase() {
    fs::create_directories(folder_ / "in/deep");
    write_bvh(folder_ / "in/anna_walk_001.bvh", walk_);
    write_bvh(folder_ / "in/anna_walk_002.bvh", swaying_motion(template_skeleton(), 2, 90, 60.0));
    write_bvh(folder_ / "in/deep/anna_turn_001.bvh",
              swaying_motion(template_skeleton(), 3, 70, 60.0));
    folder_.write("in/notes.txt", "no motion");
  }

  // Names of what the folder holds, so that leftovers show.
  std::vector<std::string> listing() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  static BuildOptions without_tempo_copies() {
    BuildOptions options;
    options.tempo_copies.clear();
    return options;
  }

  const TemporaryFolder folder_;
  const Motion walk_ = swaying_motion(template_skeleton(), 1, 121, 60.0);
  const fs::path output_ = folder_ / "out.smdb";
};

TEST_F(BuildDatabase, CountsAndNamesWhatItTookIn) {
  const BuildReport report = build_database({folder_ / "in"}, output_, without_tempo_copies());
  EXPECT_EQ(report.num_files, 3);
  EXPECT_EQ(report.num_clips, 3);
  EXPECT_TRUE(report.skipped.empty());
  const auto database = MotionDatabase::open(output_);
  EXPECT_EQ(database->num_frames(), report.num_frames);
  ASSERT_EQ(database->clips().size(), 3U);
  EXPECT_EQ(database->clips()[0].source, "anna_walk_001.bvh");
  EXPECT_EQ(database->clips()[0].actor, "anna");
  EXPECT_EQ(database->clips()[0].motion_class, "walk");
  EXPECT_EQ(database->clips()[0].source_hash.size(), 16U);
  EXPECT_EQ(database->clips()[2].source, "deep/anna_turn_001.bvh");
}

TEST_F(BuildDatabase, HoldsTheRowsOfTheMotionsThemselves) {
  build_database({folder_ / "in"}, output_, without_tempo_copies());
  const auto database = MotionDatabase::open(output_);
  const DatabaseRows expected = database_rows(walk_, 25.0);
  const auto near = [&](const DatabaseRows::Rows& rows, const DatabaseRows::Rows& wanted,
                        float tolerance) {
    ASSERT_EQ(database->clips()[0].num_frames(), wanted.rows());
    EXPECT_LT((rows.topRows(wanted.rows()) - wanted).cwiseAbs().maxCoeff(), tolerance);
  };
  near(database->positions().all(), expected.positions, 1e-4F);
  near(database->angles().all(), expected.angles, 2e-4F);
  near(database->root_motion(), expected.root_motion, 1e-3F);
  near(database->contacts().cast<float>(), expected.contacts, 0.5F);
  for (std::size_t s = 0; s < all_sites().size(); ++s) {
    const SiteRows& site = database->site(s);
    const auto of_site = [&](const DatabaseRows::Rows& rows) {
      return DatabaseRows::Rows(rows.middleCols(static_cast<Eigen::Index>(3 * s), 3));
    };
    near(site.specific_force_end.all(), of_site(expected.specific_force_end), 2e-2F);
    near(site.specific_force_pivot.all(), of_site(expected.specific_force_pivot), 2e-2F);
    near(site.angular_velocity.all(), of_site(expected.angular_velocity), 1e-3F);
    near(site.gravity_direction.all(), of_site(expected.gravity_direction), 1e-4F);
  }
}

TEST_F(BuildDatabase, AddsMirroredAndReversedCopies) {
  BuildOptions options = without_tempo_copies();
  options.add_mirrored = options.add_reversed = true;
  EXPECT_EQ(build_database({folder_ / "in/anna_walk_001.bvh"}, output_, options).num_clips, 4);
  const auto database = MotionDatabase::open(output_);
  bool seen[2][2] = {};
  for (const Clip& clip : database->clips()) {
    EXPECT_EQ(clip.num_frames(), database->clips()[0].num_frames());
    seen[clip.is_mirrored][clip.is_reversed] = true;
    const Motion base = clip.is_mirrored ? mirrored(walk_, standard_left_right()) : walk_;
    const DatabaseRows expected = database_rows(clip.is_reversed ? reversed(base) : base, 25.0);
    EXPECT_LT(
        (database->positions().rows_of_clip(clip.begin, clip.num_frames()) - expected.positions)
            .cwiseAbs()
            .maxCoeff(),
        1e-4F);
  }
  EXPECT_TRUE(seen[0][0] && seen[0][1] && seen[1][0] && seen[1][1]);
}

TEST_F(BuildDatabase, AddsCopiesAtOtherTempos) {
  BuildOptions options;
  options.tempo_copies = {0.5, 2.0};
  EXPECT_EQ(build_database({folder_ / "in/anna_walk_001.bvh"}, output_, options).num_clips, 3);
  const auto database = MotionDatabase::open(output_);
  const auto positions = [&](const Clip& clip, int frame) {
    return database->positions().row(clip.begin + frame);
  };
  ASSERT_EQ(database->clips().size(), 3U);
  const Clip& walk = database->clips()[0];
  for (std::size_t c = 1; c < 3; ++c) {
    const Clip& copy = database->clips()[c];
    EXPECT_EQ(copy.tempo, options.tempo_copies[c - 1]);
    EXPECT_NEAR(copy.num_frames(), walk.num_frames() / copy.tempo, 2.0);
  }
  for (int frame = 4; frame < 20; ++frame) {  // each frame of the walk at its time in the copies
    const auto original = positions(walk, 2 * frame);
    EXPECT_LT((positions(database->clips()[1], 4 * frame) - original).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_LT((positions(database->clips()[2], frame) - original).cwiseAbs().maxCoeff(), 0.06);
  }
  for (const double tempo : {0.0, -1.0, 100.0, std::nan("")}) {
    options.tempo_copies = {tempo};
    EXPECT_REFUSED(ConfigError, "a tempo must be between",
                   build_database({folder_ / "in"}, output_, options));
  }
}

TEST_F(BuildDatabase, LeavesTempoCopiesOutOfLargeDatabasesAndSaysSo) {
  BuildOptions options;
  options.max_frames_with_copies = 100;
  const BuildReport report = build_database({folder_ / "in"}, output_, options);
  EXPECT_EQ(report.num_clips, 3);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_TRUE(contains(report.warnings[0], "copies at other tempos are left out"));
}

TEST_F(BuildDatabase, LeavesOutWhatIsExcluded) {
  BuildOptions options = without_tempo_copies();
  options.exclude = {"*_walk_*"};
  const auto files = find_source_files({folder_ / "in"}, options.exclude);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].path.filename(), "anna_turn_001.bvh");
  EXPECT_EQ(build_database({folder_ / "in"}, output_, options).num_clips, 1);
  EXPECT_REFUSED(FormatError, "every motion file is excluded",
                 find_source_files({folder_ / "in"}, {"*"}));
}

TEST_F(BuildDatabase, ListsEachFileOnceAndSorted) {
  const auto files = find_source_files(
      {folder_ / "in", folder_ / "in/deep", folder_ / "in/anna_walk_002.bvh"}, {});
  EXPECT_EQ(files.size(), 3U);
  EXPECT_TRUE(std::is_sorted(files.begin(), files.end(),
                             [](const auto& a, const auto& b) { return a.path < b.path; }));
}

TEST_F(BuildDatabase, RefusesSourcesThatAreNoMotion) {
  EXPECT_REFUSED(FormatError, "no such file or folder",
                 find_source_files({folder_ / "nowhere"}, {}));
  EXPECT_REFUSED(FormatError, "is no motion file",
                 find_source_files({folder_ / "in/notes.txt"}, {}));
  EXPECT_REFUSED(FormatError, "holds no motion file", find_source_files({}, {}));
  fs::create_directories(folder_ / "empty");
  EXPECT_REFUSED(FormatError, "holds no motion file", find_source_files({folder_ / "empty"}, {}));
  BuildOptions options;
  for (const double rate : {0.0, -25.0, 1e6, std::nan("")}) {
    options.rate_hz = rate;
    EXPECT_REFUSED(ConfigError, "the frame rate must be between",
                   build_database({folder_ / "in"}, output_, options));
  }
}

TEST_F(BuildDatabase, SkipsBrokenFilesAndSaysWhyUnlessStrict) {
  folder_.write("in/broken.bvh", "HIERARCHY\nROOT a\n{\n");
  folder_.write("in/fish.bvh",
                "HIERARCHY\nROOT fish\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n"
                "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.01\n0 0 0\n"
                "0 0 0\n0 0 0\n");
  write_bvh(folder_ / "in/short.bvh", resting_motion(template_skeleton(), 2, 60.0));
  const BuildReport report = build_database({folder_ / "in"}, output_, without_tempo_copies());
  EXPECT_EQ(report.num_files, 3);
  ASSERT_EQ(report.skipped.size(), 3U);
  EXPECT_TRUE(contains(report.skipped[0].reason, "broken.bvh:"));
  EXPECT_TRUE(contains(report.skipped[1].reason, "not recognised as a human body"));
  EXPECT_TRUE(contains(report.skipped[2].reason, "fewer than 3 frames"));
  fs::remove(output_);
  BuildOptions strict;
  strict.is_strict = true;
  EXPECT_REFUSED(FormatError, "broken.bvh:", build_database({folder_ / "in"}, output_, strict));
  EXPECT_EQ(listing(), std::vector<std::string>{"in"});
}

TEST_F(BuildDatabase, LeavesNothingBehindWhenItFails) {
  folder_.write("broken.bvh", "HIERARCHY\n");
  EXPECT_REFUSED(FormatError, "none of 1 motion files can be used",
                 build_database({folder_ / "broken.bvh"}, output_, {}));
  EXPECT_EQ(listing(), (std::vector<std::string>{"broken.bvh", "in"}));
  EXPECT_THROW(build_database({folder_ / "in"}, folder_ / "none/out.smdb", {}),
               fs::filesystem_error);
  EXPECT_EQ(listing(), (std::vector<std::string>{"broken.bvh", "in"}));
}

TEST_F(BuildDatabase, KeepsTheOldFileWhenItIsCancelledAtAnyTime) {
  folder_.write("out.smdb", "the old one");
  std::size_t steps = 0;
  build_database({folder_ / "in"}, folder_ / "counted.smdb", {},
                 Progress([&](std::size_t done, std::size_t total, std::string_view) {
                   EXPECT_LT(done, total);
                   return ++steps > 0;
                 }));
  fs::remove(folder_ / "counted.smdb");
  EXPECT_GE(steps, 6U);
  for (std::size_t stop = 0; stop < steps; ++stop) {
    std::size_t step = 0;
    const Progress cancelling(
        [&](std::size_t, std::size_t, std::string_view) { return step++ < stop; });
    EXPECT_THROW(build_database({folder_ / "in"}, output_, {}, cancelling), Cancelled);
  }
  EXPECT_EQ(listing(), (std::vector<std::string>{"in", "out.smdb"}));
  EXPECT_EQ(fs::file_size(output_), 11U);
}

}  // namespace
}  // namespace sparse_mocap
