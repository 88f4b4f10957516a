// SPDX-License-Identifier: GPL-3.0-or-later
//
// What BVH files say is read as they mean it.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "formats/format_test_support.hpp"
#include "formats/textbook_rotations.hpp"
#include "sparse_mocap/formats/bvh.hpp"

namespace sparse_mocap {
namespace {

using testing::has_warning;
using testing::kAngles;
using testing::kOrders;
using testing::matrix_of;
using testing::TemporaryFolder;

MotionFile read_text(const std::string& text, ReadOptions options = {.unit_m = 1.0}) {
  const TemporaryFolder folder;
  return testing::sound(read_bvh(folder.write("walk.bvh", text), options));
}

const std::string kTwoJoints =
    "HIERARCHY\n"
    "ROOT Hips\n"
    "{\n"
    "  OFFSET 1 2 3\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT Chest\n"
    "  {\n"
    "    OFFSET 0 1 0\n"
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 0 0.5 0\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.025\n"
    "0 1 0 0 0 0 0 0 0\n"
    "4 5 6 90 0 0 0 90 0\n";

// A file with one joint: its channels, its offset (1, 2, 3) and one row.
std::string one_joint(const std::string& channels, const std::string& row) {
  return "HIERARCHY ROOT A { OFFSET 1 2 3 CHANNELS " + channels +
         " } MOTION\nFrames: 1\nFrame Time: 0.01\n" + row + "\n";
}

Mat3 rotation_of(const MotionFile& file, int frame, int joint) {
  return file.motion.rotation(frame, joint).toRotationMatrix();
}

std::string rotation_channels(const char* order) {
  std::string names;
  for (const char* letter = order; *letter != '\0'; ++letter)
    names += std::string(" ") + *letter + "rotation";
  return names;
}

TEST(ReadBvh, ReadsTheTreeAndTheMotion) {
  const auto file = read_text(kTwoJoints);
  const auto& skeleton = file.motion.skeleton;
  ASSERT_EQ(skeleton.num_joints(), 2);
  EXPECT_EQ(skeleton.joint(0).name, "Hips");
  EXPECT_EQ(skeleton.joint(1).name, "Chest");
  EXPECT_EQ(skeleton.joint(1).parent, 0);
  EXPECT_EQ(skeleton.joint(1).offset_parent, Vec3(0, 1, 0));
  EXPECT_EQ(skeleton.joint(0).bone, Vec3(0, 0, 0));
  EXPECT_EQ(skeleton.joint(1).bone, Vec3(0, 0.5, 0));
  EXPECT_EQ(skeleton.joint(1).axes, (std::vector<Axis>{Axis::z, Axis::x, Axis::y}));
  ASSERT_EQ(file.motion.num_frames(), 2);
  EXPECT_EQ(file.motion.frame_time_s, 0.025);
  EXPECT_EQ(file.motion.root_positions[1], Vec3(4, 5, 6));
  EXPECT_TRUE(file.motion.offset_tracks.empty());
  EXPECT_TRUE(file.warnings.empty());
  // Turned by 90 degrees about z, up points to -x; the chest then tips about its x.
  const auto pose = file.motion.transforms(1);
  EXPECT_TRUE(pose.pivot[1].isApprox(Vec3(3, 5, 6), 1e-12));
  EXPECT_TRUE(pose.end[1].isApprox(Vec3(3, 5, 6.5), 1e-12));
}

TEST(ReadBvh, ScalesLengthsByTheUnit) {
  const auto file = read_text(kTwoJoints, {});
  EXPECT_TRUE(file.motion.root_positions[1].isApprox(Vec3(0.04, 0.05, 0.06)));
  EXPECT_TRUE(file.motion.skeleton.joint(1).offset_parent.isApprox(Vec3(0, 0.01, 0)));
}

TEST(ReadBvh, HonoursAllSixOrders) {
  for (const auto& order : kOrders) {
    const auto file = read_text(one_joint("3" + rotation_channels(order.name), kAngles));
    EXPECT_LT((rotation_of(file, 0, 0) - matrix_of(order)).cwiseAbs().maxCoeff(), 1e-14)
        << order.name;
    EXPECT_EQ(file.motion.root_positions[0], Vec3(1, 2, 3)) << "no position channel: OFFSET";
  }
}

TEST(ReadBvh, HonoursPositionsAfterAndBetweenRotations) {
  const Mat3 expected = matrix_of(kOrders[5]);
  const auto after = read_text(one_joint(
      "6 Zrotation Xrotation Yrotation Xposition Yposition Zposition", kAngles + " 7 8 9"));
  EXPECT_LT((rotation_of(after, 0, 0) - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(after.motion.root_positions[0], Vec3(7, 8, 9));
  const auto between =
      read_text(one_joint("6 Yposition Zrotation Zposition Xrotation Xposition Yrotation",
                          "8 53.13010235415598 9 22.619864948040426 7 28.072486935852957"));
  EXPECT_LT((rotation_of(between, 0, 0) - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(between.motion.root_positions[0], Vec3(7, 8, 9));
}

TEST(ReadBvh, TakesTheOffsetWherePositionChannelsAreMissing) {
  const auto file = read_text(one_joint("1 Yposition", "8"));
  EXPECT_EQ(file.motion.root_positions[0], Vec3(1, 8, 3));
}

TEST(ReadBvh, TakesFewerThanThreeRotations) {
  EXPECT_TRUE(rotation_of(read_text(one_joint("1 Xrotation", "90")), 0, 0)
                  .isApprox((Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished()));
  // Turning about y first and about z then: x goes to -z, which z keeps.
  EXPECT_TRUE(rotation_of(read_text(one_joint("2 Zrotation Yrotation", "90 90")), 0, 0)
                  .isApprox((Mat3() << 0, -1, 0, 0, 0, 1, -1, 0, 0).finished()));
  const auto fixed = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation JOINT B { OFFSET 0 1 0 CHANNELS 0 } }\n"
      "MOTION Frames: 1 Frame Time: 0.1\n90");
  EXPECT_TRUE(rotation_of(fixed, 0, 1).isIdentity());
  EXPECT_TRUE(fixed.motion.skeleton.joint(1).axes.empty());
}

TEST(ReadBvh, ReadsHugeAnglesAndFlipsAsTheyAre) {
  const auto huge = read_text(one_joint("1 Zrotation", "1000080"));  // 2778 turns and 0
  EXPECT_TRUE(rotation_of(huge, 0, 0).isIdentity(1e-9));
  const auto flip = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Zrotation } MOTION Frames: 2 Frame Time: 0.1\n"
      "179\n-179");
  EXPECT_NEAR(flip.motion.rotation(0, 0).angularDistance(flip.motion.rotation(1, 0)),
              2 * kRadiansPerDegree, 1e-9);
}

TEST(ReadBvh, LineEndsAndMarksDoNotMatter) {
  const auto expected = read_text(kTwoJoints);
  const auto with_line_end = [](const std::string& line_end) {
    std::string text;
    for (const char c : kTwoJoints) text += c == '\n' ? line_end : std::string(1, c);
    return text;
  };
  const std::array<std::string, 7> texts{
      with_line_end("\r\n"),       with_line_end("\r"),
      "\xEF\xBB\xBF" + kTwoJoints, with_line_end("\t \t\n"),
      with_line_end("\n\n\n"),     kTwoJoints.substr(0, kTwoJoints.size() - 1),
      kTwoJoints + "\n \t\n"};
  for (const auto& text : texts) {
    const auto file = read_text(text);
    EXPECT_EQ(file.motion.root_positions, expected.motion.root_positions);
    EXPECT_EQ(rotation_of(file, 1, 1), rotation_of(expected, 1, 1));
    EXPECT_TRUE(file.warnings.empty());
  }
}

TEST(ReadBvh, BracesMayStandAnywhere) {
  const auto file = read_text(
      "HIERARCHY ROOT a{OFFSET 0 0 0 CHANNELS 3 Xrotation Yrotation Zrotation JOINT b{\n"
      "OFFSET 1 0 0 CHANNELS 3 Xrotation Yrotation Zrotation End Site{OFFSET 0 1 0}}}\n"
      "MOTION\nFrames:1\nFrame Time:.1\n1 2 3 4 5 6");
  EXPECT_EQ(file.motion.skeleton.joint(1).name, "b");
  EXPECT_EQ(file.motion.skeleton.joint(1).bone, Vec3(0, 1, 0));
}

TEST(ReadBvh, KeywordsHaveNoCase) {
  const auto file = read_text(
      "Hierarchy root A { offset 0 0 0 channels 1 XROTATION joint B { Offset 0 1 0 Channels 1 "
      "zrotation END SITE Finger_tip { OFFSET 0 2 0 } } }\n"
      "motion FRAMES: 1 frame time: 0.1\n1 2");
  EXPECT_EQ(file.motion.skeleton.joint(1).bone, Vec3(0, 2, 0));
}

TEST(ReadBvh, ChannelsMayFollowAChild) {
  // The columns are those of the joints' order, not of the order of the CHANNELS lines.
  const auto file = read_text(
      "HIERARCHY ROOT A { JOINT B { OFFSET 0 1 0 CHANNELS 1 Zrotation } OFFSET 0 0 0 CHANNELS 4 "
      "Xposition Yposition Zposition Xrotation }\nMOTION Frames: 1 Frame Time: 0.1\n1 2 3 90 45");
  EXPECT_EQ(file.motion.root_positions[0], Vec3(1, 2, 3));
  EXPECT_NEAR(Eigen::AngleAxisd(file.motion.rotation(0, 0)).angle(), kPi / 2, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(file.motion.rotation(0, 1)).angle(), kPi / 4, 1e-12);
}

TEST(ReadBvh, AnEndSiteBesideAJointIsNoBone) {
  const auto file = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation End Site { OFFSET 9 9 9 } JOINT B { "
      "OFFSET 0 1 0 CHANNELS 0 } }\nMOTION Frames: 1 Frame Time: 0.1\n0");
  EXPECT_EQ(file.motion.skeleton.joint(0).bone, Vec3(0, 0, 0));
}

TEST(ReadBvh, AnEndSiteWithoutOffsetIsZero) {
  const auto file = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation End Site { } }\n"
      "MOTION Frames: 1 Frame Time: 0.1\n0");
  EXPECT_EQ(file.motion.skeleton.joint(0).bone, Vec3(0, 0, 0));
  EXPECT_TRUE(has_warning(file, "End Site without OFFSET"));
}

TEST(ReadBvh, NamesAreMadeUsable) {
  const std::string rest = " { OFFSET 0 1 0 CHANNELS 0 } }\nMOTION Frames: 1 Frame Time: 0.1\n0";
  const std::string start = "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation JOINT ";
  const auto spaced = read_text(start + "Left  Arm" + rest);
  EXPECT_EQ(spaced.motion.skeleton.joint(1).name, "Left_Arm");
  EXPECT_TRUE(has_warning(spaced, "\"Left_Arm\""));
  const auto latin1 = read_text(start +
                                "H\xFC"
                                "fte" +
                                rest);
  EXPECT_EQ(latin1.motion.skeleton.joint(1).name, "H\\xfcfte");
  EXPECT_TRUE(has_warning(latin1, "not UTF-8"));
  const auto utf8 = read_text(start +
                              "H\xC3\xBC"
                              "fte:L" +
                              rest);
  EXPECT_EQ(utf8.motion.skeleton.joint(1).name,
            "H\xC3\xBC"
            "fte:L");
  EXPECT_TRUE(utf8.warnings.empty());
  const auto longest = read_text(start + std::string(255, 'x') + rest);
  EXPECT_EQ(longest.motion.skeleton.joint(1).name.size(), 255U);
}

TEST(ReadBvh, RepeatedNamesAreNumbered) {
  const auto file = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation JOINT A { OFFSET 0 1 0 CHANNELS 0 "
      "JOINT "
      "A { OFFSET 0 1 0 CHANNELS 0 } } JOINT A_2 { OFFSET 0 1 0 CHANNELS 0 } }\n"
      "MOTION Frames: 1 Frame Time: 0.1\n0");
  const auto& skeleton = file.motion.skeleton;
  EXPECT_EQ(skeleton.joint(0).name, "A");
  EXPECT_EQ(skeleton.joint(1).name, "A_3") << "A_2 is taken by the file itself";
  EXPECT_EQ(skeleton.joint(2).name, "A_4");
  EXPECT_EQ(skeleton.joint(3).name, "A_2");
  EXPECT_TRUE(has_warning(file, "second joint named \"A\""));
}

TEST(ReadBvh, ReadsTheFirstOfSeveralRoots) {
  const auto file = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation JOINT B { OFFSET 0 1 0 CHANNELS 1 "
      "Xrotation } } ROOT C { OFFSET 0 0 0 CHANNELS 2 Xrotation Yrotation }\n"
      "MOTION Frames: 2 Frame Time: 0.1\n10 20 30 40\n50 60 70 80");
  EXPECT_EQ(file.motion.skeleton.num_joints(), 2);
  EXPECT_TRUE(has_warning(file, "further ROOT"));
  ASSERT_EQ(file.motion.num_frames(), 2);
  EXPECT_NEAR(Eigen::AngleAxisd(file.motion.rotation(1, 1)).angle(), 60 * kRadiansPerDegree, 1e-9);
}

TEST(ReadBvh, RowsMayBeWrapped) {
  const auto file = read_text(
      testing::replaced(kTwoJoints, "4 5 6 90 0 0 0 90 0\n", "4 5 6\n\n90 0 0 \n 0 90 0"));
  ASSERT_EQ(file.motion.num_frames(), 2);
  EXPECT_EQ(file.motion.root_positions[1], Vec3(4, 5, 6));
}

TEST(ReadBvh, TheRowsCountNotTheNumberDeclared) {
  const auto more = read_text(testing::replaced(kTwoJoints, "Frames: 2", "Frames: 1000000"));
  EXPECT_EQ(more.motion.num_frames(), 2);
  EXPECT_TRUE(has_warning(more, "declares 1000000 frames and has 2"));
  const auto fewer = read_text(testing::replaced(kTwoJoints, "Frames: 2", "Frames: 1"));
  EXPECT_EQ(fewer.motion.num_frames(), 2);
  EXPECT_TRUE(has_warning(fewer, "declares 1 frames and has 2"));
}

TEST(ReadBvh, TheFrameHeaderMayBeWrittenInManyWays) {
  for (const char* header :
       {"Frames : 2", "Frames:2", "Frames: 2.0", "Frames\t:\t2", "FRAMES: 2", "Frames 2"}) {
    const auto file = read_text(testing::replaced(kTwoJoints, "Frames: 2", header));
    EXPECT_EQ(file.motion.num_frames(), 2) << header;
    EXPECT_TRUE(file.warnings.empty()) << header;
  }
  for (const char* header : {"Frame Time:.025", "Frame Time : 0.025", "frame  time: 2.5e-2"}) {
    const auto file = read_text(testing::replaced(kTwoJoints, "Frame Time: 0.025", header));
    EXPECT_EQ(file.motion.frame_time_s, 0.025) << header;
  }
}

TEST(ReadBvh, MovingJointsHaveOffsetTracks) {
  const std::string text =
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition JOINT B { OFFSET 0 "
      "1 "
      "0 CHANNELS 3 Zposition Xposition Yposition } }\nMOTION Frames: 3 Frame Time: 0.1\n";
  const auto moving = read_text(text + "0 0 0 0 0 1\n0 0 0 5 6 7\n0 0 0 0 0 1\n");
  ASSERT_EQ(moving.motion.offset_tracks.size(), 1U);
  const auto& track = moving.motion.offset_tracks[0];
  EXPECT_EQ(track.joint, 1);
  EXPECT_EQ(track.offset_parent, (std::vector<Vec3>{{0, 1, 0}, {6, 7, 5}, {0, 1, 0}}));
  EXPECT_TRUE(moving.motion.transforms(1).pivot[1].isApprox(Vec3(6, 7, 5)))
      << "the channel replaces the OFFSET";
  const auto still = read_text(text + "0 0 0 0 0 1\n1 0 0 0 0 1\n2 0 0 0 0 1\n");
  EXPECT_TRUE(still.motion.offset_tracks.empty());
}

TEST(ReadBvh, SaysThatAFigureIsOfUnusualSize) {
  const auto file = read_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation End Site { OFFSET 0 1700 0 } }\n"
      "MOTION Frames: 1 Frame Time: 0.1\n0",
      {});
  EXPECT_TRUE(has_warning(file, "measures 17 m; if that is not its size, choose the file's unit"));
  EXPECT_TRUE(file.motion.skeleton.joint(0).bone.isApprox(Vec3(0, 17, 0)));
}

TEST(ReadBvh, TurnsOtherUpAxesToY) {
  std::string text = testing::replaced(kTwoJoints, "OFFSET 0 1 0", "OFFSET 0.1 0.2 1");
  text = testing::replaced(text, "0 90 0\n", "20 40 30\n");
  const auto as_written = read_text(text);
  const auto turned = [](const Vec3& v) { return Vec3(v.x(), v.z(), -v.y()); };
  const auto z_up = read_text(text, {.unit_m = 1.0, .up = Axis::z});
  const auto x_up = read_text(text, {.unit_m = 1.0, .up = Axis::x});
  const auto from = as_written.motion.transforms(1);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_TRUE(z_up.motion.transforms(1).end[j].isApprox(turned(from.end[j]), 1e-12));
    const Vec3& e = from.end[j];
    EXPECT_TRUE(x_up.motion.transforms(1).end[j].isApprox(Vec3(-e.y(), e.x(), e.z()), 1e-12));
  }
  std::array<double, 3> angles{};
  joint_angles(z_up.motion.skeleton.joint(1), rotation_of(z_up, 1, 1), nullptr, angles.data());
  EXPECT_NEAR(angles[0], 20 * kRadiansPerDegree, 1e-9) << "the file's own angles remain";
}

TEST(ReadBvh, KeepsZeroBones) {
  const auto file = read_text(testing::replaced(kTwoJoints, "OFFSET 0 1 0", "OFFSET 0 0 0"));
  EXPECT_EQ(file.motion.skeleton.joint(1).offset_parent, Vec3(0, 0, 0));
}

TEST(ReadBvh, ReadsASkeletonWithoutMotionWhenAsked) {
  const auto text =
      kTwoJoints.substr(0, kTwoJoints.find("Frames")) + "Frames: 0\nFrame Time: 0.1\n";
  const auto file = read_text(text, {.unit_m = 1.0, .allow_no_frames = true});
  EXPECT_EQ(file.motion.num_frames(), 0);
  EXPECT_EQ(file.motion.skeleton.num_joints(), 2);
}

}  // namespace
}  // namespace sparse_mocap
