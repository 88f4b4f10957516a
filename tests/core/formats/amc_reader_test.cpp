// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "formats/acclaim_test_files.hpp"

namespace sparse_mocap {
namespace {

using namespace std::string_literals;
using testing::contains;
using testing::has_warning;
using testing::kAmc;
using testing::kAsf;
using testing::read_acclaim_text;
using testing::replaced;
using testing::TemporaryFolder;

// "line: message" for this .amc, "" when it is read.
std::string error_in(const std::string& amc, const ReadOptions& options = {}) {
  return testing::error_of([&] { read_acclaim_text(kAsf, amc, options); });
}

std::string error_with(const std::string& from, const std::string& to) {
  auto error = error_in(replaced(kAmc, from, to));
  // The folder of the skeleton is another one in every run.
  const auto folder = error.find(std::filesystem::temp_directory_path().string());
  const auto name = error.find("small.asf");
  if (folder != std::string::npos && name != std::string::npos) error.erase(folder, name - folder);
  return error;
}

Mat3 matrix(const std::array<double, 9>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

const Mat3 kQuarterAboutX = matrix({1, 0, 0, 0, 0, -1, 0, 1, 0});
const Mat3 kQuarterAboutZ = matrix({0, -1, 0, 1, 0, 0, 0, 0, 1});
const Mat3 kXThenY = matrix({0, 1, 0, 0, 0, -1, -1, 0, 0});
const Mat3 kZThenX = matrix({0, -1, 0, 0, 0, -1, 1, 0, 0});

Mat3 rotation_of(const MotionFile& file, const std::string& joint) {
  return file.motion.rotation(1, file.motion.skeleton.find(joint)).toRotationMatrix();
}

TEST(ReadAmc, ReadsTheMotion) {
  const auto file = read_acclaim_text(kAsf, kAmc);
  ASSERT_EQ(file.motion.num_frames(), 2);
  EXPECT_EQ(file.motion.frame_time_s, 1.0 / 120.0);
  EXPECT_TRUE(file.motion.root_positions[1].isApprox(Vec3(1, 2, 3)));
  EXPECT_TRUE(rotation_of(file, "root").isApprox(kQuarterAboutZ));
  EXPECT_TRUE(rotation_of(file, "thigh").isApprox(kXThenY));
  EXPECT_TRUE(rotation_of(file, "shin").isApprox(kQuarterAboutX));
  EXPECT_TRUE(rotation_of(file, "fin").isIdentity());
  EXPECT_TRUE(file.warnings.empty());
  // Standing still, everything hangs down from the root.
  const auto pose = file.motion.transforms(0);
  EXPECT_TRUE(pose.end[2].isApprox(Vec3(1, 1.1, 3)));
  EXPECT_TRUE(pose.end[3].isApprox(Vec3(1.1, 1.5, 3)));
}

TEST(ReadAmc, TurnsInTheFrameOfTheAxis) {
  // With axis (90 0 0) the bone's y is the world's z: `ry 90` turns about the world's z.
  const auto asf = replaced(kAsf, "axis 0 0 0 XYZ", "axis 90 0 0 XYZ");
  const auto file = read_acclaim_text(asf, replaced(kAmc, "thigh 90 90 0", "thigh 0 90 0"));
  EXPECT_TRUE(rotation_of(file, "thigh").isApprox(kQuarterAboutZ));
}

TEST(ReadAmc, HonoursTheOrderOfDof) {
  const auto asf = replaced(kAsf, "dof rx ry rz", "dof rz rx ry");
  const auto file = read_acclaim_text(asf, replaced(kAmc, "thigh 90 90 0", "thigh 90 90 0"));
  EXPECT_TRUE(rotation_of(file, "thigh").isApprox(kZThenX)) << "z turns first";
}

TEST(ReadAmc, HonoursTheOrderOfTheRoot) {
  const auto asf = replaced(kAsf, "order TX TY TZ RX RY RZ", "order rz TY rx TX ry TZ");
  auto amc = replaced(kAmc, "root 1 2 3 0 0 90", "root 90 2 90 1 0 3");
  amc = replaced(amc, "root 1 2 3 0 0 0", "root 0 2 0 1 0 3");
  const auto file = read_acclaim_text(asf, amc);
  EXPECT_TRUE(file.motion.root_positions[1].isApprox(Vec3(1, 2, 3)));
  EXPECT_TRUE(rotation_of(file, "root").isApprox(kZThenX));
}

TEST(ReadAmc, ThePresetOfTheRootOffsetsTheWholeCapture) {
  // Position is added; orientation C turns all: R_world = C R_amc, here C = x then y, R_amc = z.
  auto asf = replaced(kAsf, "position 0 0 0", "position 10 20 30");
  asf = replaced(asf, "orientation 0 0 0", "orientation 90 90 0");
  const auto file = read_acclaim_text(asf, kAmc);
  EXPECT_TRUE(file.motion.root_positions[1].isApprox(Vec3(11, 22, 33)));
  // Frame 1: the thigh points down the preset frame's -y, which is C (0 -1 0) = (-1 0 0).
  EXPECT_TRUE(file.motion.transforms(0).end[1].isApprox(Vec3(10.5, 22, 33)));
  // Frame 2: bone in the root's frame: thigh turned by x then y: (0 -1 0) -> (-1 0 0)...
  // ...then about z by R_amc: (-1 0 0) -> (0 -1 0), then C: -> (-1 0 0).
  EXPECT_TRUE(file.motion.transforms(1).end[1].isApprox(Vec3(10.5, 22, 33)));
  const auto& root = file.motion.skeleton.joint(0);
  std::array<double, 3> angles{};
  joint_angles(root, rotation_of(file, "root"), nullptr, angles.data());
  EXPECT_NEAR(angles[0], kPi / 2, 1e-9) << "the angles are those of the .amc";
  const auto other_order =
      read_acclaim_text(replaced(asf, "axis XYZ\n  position", "axis ZYX\n  position"), kAmc);
  // y turns first, then x: (0 -1 0) -> (0 -1 0) -> (0 0 -1).
  EXPECT_TRUE(other_order.motion.transforms(0).end[1].isApprox(Vec3(11, 22, 32.5)));
}

TEST(ReadAmc, TranslationsOfBonesBecomeOffsetTracks) {
  auto asf = replaced(kAsf, "dof rx\n    limits (0 0)\n", "dof tx ty tz rx l\n");
  asf = replaced(asf, "length 0.4\n    axis 0 0 0", "length 0.4\n    axis 0 0 90");
  auto amc = replaced(kAmc, "shin 0\n", "shin 0 0 0 0 0\n");
  amc = replaced(amc, "shin 90\n", "shin 0.1 0.2 0.3 0 0.5\n");
  const auto file = read_acclaim_text(asf, amc);
  ASSERT_EQ(file.motion.offset_tracks.size(), 1U);
  EXPECT_EQ(file.motion.offset_tracks[0].joint, 2);
  EXPECT_TRUE(file.motion.offset_tracks[0].offset_parent[1].isApprox(Vec3(-0.2, 0.1, 0.3)))
      << "in the frame of the axis";
  EXPECT_TRUE(has_warning(file, "channel l"));
}

TEST(ReadAmc, HonoursRadians) {
  auto amc = replaced(kAmc, ":DEGREES", ":RADIANS");
  amc = replaced(amc, "root 1 2 3 0 0 90", "root 1 2 3 0 0 1.5707963267948966");
  const auto file = read_acclaim_text(kAsf, amc);
  EXPECT_TRUE(rotation_of(file, "root").isApprox(kQuarterAboutZ));
  const auto by_asf =
      read_acclaim_text(replaced(kAsf, "angle deg", "angle rad"), replaced(amc, ":RADIANS\n", ""));
  EXPECT_TRUE(rotation_of(by_asf, "root").isApprox(kQuarterAboutZ));
  EXPECT_TRUE(has_warning(by_asf, "radians are assumed"));
}

TEST(ReadAmc, WarnsAboutAMissingHeader) {
  const auto file = read_acclaim_text(kAsf, kAmc.substr(kAmc.find("1\n")));
  EXPECT_TRUE(has_warning(file, ":FULLY-SPECIFIED is missing"));
  EXPECT_TRUE(has_warning(file, ":DEGREES is missing; degrees are assumed"));
  EXPECT_EQ(file.motion.num_frames(), 2);
}

TEST(ReadAmc, TakesTheRateFromTheFileOrTheOptions) {
  EXPECT_EQ(read_acclaim_text(kAsf, kAmc, {.amc_rate_hz = 60.0}).motion.frame_time_s, 1.0 / 60.0);
  const auto amc = replaced(kAmc, ":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 30");
  EXPECT_EQ(read_acclaim_text(kAsf, amc).motion.frame_time_s, 1.0 / 30.0);
}

TEST(ReadAmc, NamesHaveNoCase) {
  auto amc = replaced(kAmc, "thigh 90 90 0", "THIGH 90 90 0");
  amc = replaced(amc, "root 1 2 3 0 0 0", "Root 1 2 3 0 0 0");
  EXPECT_TRUE(rotation_of(read_acclaim_text(kAsf, amc), "thigh").isApprox(kXThenY));
}

TEST(ReadAmc, BonesMayComeInAnyOrder) {
  const auto amc =
      replaced(kAmc, "thigh 90 90 0\nshin 90\n", "shin 90\nfin\n\nthigh (90, 90, 0) # bent\n");
  const auto file = read_acclaim_text(kAsf, amc);
  EXPECT_TRUE(rotation_of(file, "thigh").isApprox(kXThenY));
  EXPECT_TRUE(rotation_of(file, "shin").isApprox(kQuarterAboutX));
}

TEST(ReadAmc, LineEndsDoNotMatter) {
  for (const auto* line_end : {"\r\n", "\r", "\n\n"}) {
    std::string text;
    for (const char c : kAmc) text += c == '\n' ? line_end : std::string(1, c);
    const auto file = read_acclaim_text(kAsf, "\xEF\xBB\xBF" + text);
    EXPECT_EQ(file.motion.num_frames(), 2);
    EXPECT_TRUE(rotation_of(file, "thigh").isApprox(kXThenY));
  }
}

TEST(ReadAmc, RecordsGapsBetweenFrameNumbers) {
  const auto file = read_acclaim_text(kAsf, replaced(kAmc, "\n2\n", "\n5\n"));
  EXPECT_EQ(file.motion.num_frames(), 2);
  EXPECT_TRUE(has_warning(file, "frame number 5 follows 1"));
  EXPECT_TRUE(has_warning(file, "3 frame numbers are missing"));
  const auto from_zero =
      read_acclaim_text(kAsf, replaced(replaced(kAmc, "\n1\n", "\n0\n"), "\n2\n", "\n1\n"));
  EXPECT_TRUE(from_zero.warnings.empty());
}

TEST(ReadAmcRefuses, BadFrameNumbers) {
  EXPECT_EQ(error_with("\n2\n", "\n1\n"), "8: :8:1: frame 1 occurs twice; remove one of them");
  EXPECT_EQ(error_with("\n1\n", "\n3\n"),
            "8: :8:1: frame number 2 follows 3; put the frames in order");
  EXPECT_EQ(error_with("\n1\n", "\n1.5\n"),
            "4: :4:1: expected a frame number alone on its line, got \"1.5\"; number the frames 1, "
            "2, 3 and so on");
  EXPECT_EQ(error_with("\n1\n", "\n"),
            "4: :4:1: expected a frame number, got \"root\"; write a decimal number such as -1.5");
  EXPECT_EQ(error_with("\n1\n", "\n1 2\n"),
            "4: :4:1: expected a frame number alone on its line, got \"1\"; number the frames 1, "
            "2, 3 and so on");
}

TEST(ReadAmcRefuses, BonesThatDoNotFitTheSkeleton) {
  EXPECT_EQ(error_with("shin 0\n", "shin 0\ntoe 1\n"),
            "8: :8:1: bone \"toe\" is not in small.asf; use the .asf of this actor");
  EXPECT_EQ(error_with("thigh 0 0 0\n", ""),
            "4: :4:1: bone \"thigh\" is missing in frame 1; the skeleton is small.asf");
  EXPECT_EQ(error_with("shin 0\n", "shin 0\nshin 0\n"),
            "8: :8:1: bone \"shin\" occurs twice in frame 1; remove one of the lines");
  EXPECT_EQ(error_with("root 1 2 3 0 0 90\n", ""),
            "11: :11:1: bone \"root\" is missing in frame 2; the file may be cut off; 1 complete "
            "frames come before");
}

TEST(ReadAmcRefuses, WrongValues) {
  EXPECT_EQ(error_with("thigh 0 0 0", "thigh 0 0"),
            "6: :6:10: bone \"thigh\" in frame 1 needs 3 values, got 2; the skeleton is small.asf");
  EXPECT_EQ(
      error_with("thigh 0 0 0", "thigh 0 0 0 0"),
      "6: :6:13: bone \"thigh\" in frame 1 needs 3 values, got more; the skeleton is small.asf");
  EXPECT_EQ(error_with("thigh 0 0 0", "thigh 0 nan 0"),
            "6: :6:9: expected a number, got \"nan\"; write a decimal number such as -1.5");
  EXPECT_EQ(error_with("thigh 0 0 0", "thigh 0 -1.#IND 0"),
            "6: :6:9: expected a number, got \"-1.#IND\"; write a decimal number such as -1.5");
  EXPECT_EQ(error_with("thigh 0 0 0", "thigh 0 x 0"),
            "6: :6:9: expected a number, got \"x\"; write a decimal number such as -1.5");
  EXPECT_TRUE(contains(error_with("root 1 2 3", "root 1e30 2 3"), "out of range"));
}

TEST(ReadAmcRefuses, BrokenFiles) {
  EXPECT_EQ(error_in(""), "1: :1:1: the file is empty; export it again");
  EXPECT_EQ(error_in(":FULLY-SPECIFIED\n:DEGREES\n"),
            "3: :3:1: the file has no frames; export the frames, or read only the "
            "skeleton");
  EXPECT_EQ(
      error_with("\n2\n", "\n:DEGREES\n2\n"),
      "8: :8:1: a second header \":DEGREES\" after frame 1; remove it, or cut the file in two");
  EXPECT_EQ(error_with("thigh 90 90 0\nshin 90\n", "thigh 90 90 0\n"),
            "11: :11:1: bone \"shin\" is missing in frame 2; the file may be cut off; 1 complete "
            "frames come before");
  EXPECT_EQ(
      error_in(kAmc, {.max_frames = 1}),
      "8: :8:1: there are more frames than the limit of 1; raise the limit max_frames if that "
      "is intended");
  EXPECT_EQ(error_with(":DEGREES", ":SAMPLES-PER-SECOND 0"),
            "3: :3:21: the rate must be from 1 to 10000 samples a second; correct it");
}

TEST(ReadAmcRefuses, EveryTruncation) {
  const TemporaryFolder folder;
  const auto skeleton = read_asf(folder.write("small.asf", kAsf));
  const auto second_frame = kAmc.find("2\nroot");
  for (std::size_t length = 0; length < kAmc.size(); ++length) {
    const auto path = folder.write("small_01.amc", kAmc.substr(0, length));
    const bool ends_with_a_frame =
        (length >= second_frame - 1 && length <= second_frame) || length >= kAmc.size() - 2;
    EXPECT_EQ(testing::error_of([&] { read_amc(path, skeleton); }).empty(), ends_with_a_frame)
        << length;
  }
}

TEST(ReadMotionFile, KnowsItsFormatsByName) {
  EXPECT_TRUE(is_motion_file("a/b.bvh"));
  EXPECT_TRUE(is_motion_file("HDM_bk_sneak.AMC"));
  EXPECT_FALSE(is_motion_file("a.asf"));
  EXPECT_FALSE(is_motion_file("bvh"));
  EXPECT_EQ(testing::error_of([] { read_motion_file("a.fbx"); }),
            "0: : is not a motion file; the name must end in .bvh or .amc");
}

TEST(ReadMotionFile, RefusesAnAmcWithoutAsf) {
  const TemporaryFolder folder;
  const auto path = folder.write("02_01.amc", kAmc);
  EXPECT_TRUE(contains(testing::error_of([&] { read_motion_file(path); }), "there is no .asf"));
}

TEST(ReadMotionFile, SaysWhichSkeletonItTookWhenTheNamesDoNotTell) {
  const TemporaryFolder folder;
  folder.write("skeleton.asf", kAsf);
  EXPECT_TRUE(has_warning(read_motion_file(folder.write("walk.amc", kAmc)),
                          "read with skeleton.asf, the only .asf"));
}

}  // namespace
}  // namespace sparse_mocap
