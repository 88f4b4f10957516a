// SPDX-License-Identifier: GPL-3.0-or-later
//
// What BVH files get wrong is refused where it stands.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

using namespace std::string_literals;
using testing::replaced;
using testing::TemporaryFolder;

const std::string kFile =
    "HIERARCHY\n"                                     // 1
    "ROOT A {\n"                                      // 2
    "  OFFSET 0 1 0\n"                                // 3
    "  CHANNELS 3 Zrotation Xrotation Yrotation\n"    // 4
    "  JOINT B {\n"                                   // 5
    "    OFFSET 0 1 0\n"                              // 6
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"  // 7
    "    End Site { OFFSET 0 1 0 }\n"                 // 8
    "  }\n"                                           // 9
    "}\n"                                             // 10
    "MOTION\n"                                        // 11
    "Frames: 2\n"                                     // 12
    "Frame Time: 0.1\n"                               // 13
    "1 2 3 4 5 6\n"                                   // 14
    "7 8 9 10 11 12\n";                               // 15

// "line: message" for this text, "" when it is read.
std::string error_in(const std::string& text, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  const auto path = folder.write("walk.bvh", text);
  return testing::error_of([&] { read_bvh(path, options); });
}

std::string error_with(const std::string& from, const std::string& to) {
  return error_in(replaced(kFile, from, to));
}

TEST(ReadBvhRefuses, FilesThatAreNoBvh) {
  EXPECT_EQ(error_in(""), "1: :1:1: the file is empty; the file may be cut off; export it again");
  EXPECT_EQ(error_in(" \n\t"),
            "2: :2:2: the file is empty; the file may be cut off; export it again");
  EXPECT_EQ(error_in("HIERARCHY"),
            "1: :1:10: there is no ROOT; the file may be cut off; export it again");
  EXPECT_EQ(error_in("hello"),
            "1: :1:1: not a BVH file: expected HIERARCHY, got \"hello\"; choose a .bvh file");
  EXPECT_EQ(error_in("\xFF\xFEH\0"s), "1: :1:1: is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(error_with("JOINT B", "JOINT B\0"s),
            "5: :5: holds a NUL byte, so it is not text; save it as text");
  EXPECT_EQ(error_in("HIERARCHY MOTION"),
            "1: :1:11: there is no ROOT before MOTION; put the joints before it");
}

TEST(ReadBvhRefuses, BadNames) {
  EXPECT_EQ(error_with("JOINT B {", "JOINT {"),
            "5: :5:9: the name after JOINT is missing; write it on the same line");
  EXPECT_EQ(error_with("JOINT B {", "JOINT\nB {"),
            "6: :6:1: the name after JOINT is missing; write it on the same line");
  EXPECT_EQ(error_with("JOINT B", "JOINT " + std::string(10000, 'x')),
            "5: :5:9: a name has 10000 bytes, at most 255 are accepted; shorten it");
  std::string many_words;
  for (int i = 0; i < 200; ++i) many_words += "ab ";
  EXPECT_TRUE(testing::contains(error_with("JOINT B", "JOINT " + many_words), "at most 255"));
}

TEST(ReadBvhRefuses, ChannelCountsThatDoNotFit) {
  const std::string from = "CHANNELS 3 Zrotation Xrotation Yrotation";
  EXPECT_EQ(
      error_with(from, "CHANNELS 6 Zrotation Xrotation Yrotation"),
      "4: :4:3: CHANNELS says 6, but 3 channel names follow; count the names of the channels");
  EXPECT_EQ(
      error_with(from, "CHANNELS 3 Xposition Yposition Zposition Zrotation Xrotation Yrotation"),
      "4: :4:3: CHANNELS says 3, but 6 channel names follow; count the names of the channels");
  for (const char* count : {"-1", "1e9", "2.5"})
    EXPECT_EQ(error_with("CHANNELS 3", "CHANNELS "s + count),
              "4: :4:12: CHANNELS says "s + count +
                  ", it must be a whole number from 0 to 6; count the names of the channels");
  EXPECT_EQ(error_with("CHANNELS 3", "CHANNELS nan"),
            "4: :4:12: expected the number of channels after CHANNELS, got \"nan\"; write a "
            "decimal number such as -1.5");
}

TEST(ReadBvhRefuses, BadChannels) {
  const std::string from = "Zrotation Xrotation Yrotation";
  EXPECT_EQ(error_with(from, "Zrotation Zrotation Yrotation"),
            "4: :4:24: channel \"Zrotation\" is listed twice; remove one of them");
  EXPECT_EQ(error_with(from, "Zrotation Wrotation Yrotation"),
            "4: :4:24: unknown channel \"Wrotation\"; use Xposition to Zposition and "
            "Xrotation to Zrotation");
  EXPECT_EQ(error_with("  JOINT B", "CHANNELS 0\n  JOINT B"),
            "5: :5:1: a second CHANNELS of joint \"A\"; remove one of them");
  EXPECT_EQ(error_with("End Site { OFFSET 0 1 0 }", "End Site { CHANNELS 1 Xrotation }"),
            "8: :8:16: an End Site cannot have channels; remove the line");
}

TEST(ReadBvhRefuses, BadOffsets) {
  EXPECT_EQ(error_with("    OFFSET 0 1 0\n", ""),
            "8: :8:3: joint \"B\" has no OFFSET; add a line OFFSET x y z");
  EXPECT_EQ(error_with("    OFFSET 0 1 0\n", "OFFSET 0 1 0\nOFFSET 0 1 0\n"),
            "7: :7:1: a second OFFSET of joint \"B\"; remove one of them");
  EXPECT_EQ(error_with("    OFFSET 0 1 0\n", "OFFSET 0 1\n"),
            "7: :7:5: expected 3 numbers after OFFSET, got \"CHANNELS\"; write a decimal number "
            "such as -1.5");
  EXPECT_EQ(error_with("    OFFSET 0 1 0\n", "OFFSET 0 inf 0\n"),
            "6: :6:10: expected 3 numbers after OFFSET, got \"inf\"; write a decimal number such "
            "as -1.5");
  EXPECT_TRUE(error_with("    OFFSET 0 1 0\n", "OFFSET 0 1e30 0\n")
                  .starts_with("6: :6:10: \"1e30\" is 1e+28 m, which cannot be a length"));
  EXPECT_EQ(error_with("End Site { OFFSET 0 1 0 }", "End Site { OFFSET 0 1 0 OFFSET 0 1 0 }"),
            "8: :8:29: a second OFFSET of an End Site; remove one of them");
}

TEST(ReadBvhRefuses, BadNesting) {
  EXPECT_EQ(error_with("  }\n}\n", "  }\n"),
            "10: :10:1: expected OFFSET, CHANNELS, JOINT, End Site or '}' in joint \"A\", got "
            "\"MOTION\"; check the braces before it");
  EXPECT_EQ(error_with("  }\n}\n", "}}}\n"),
            "9: :9:3: expected ROOT or MOTION, got \"}\"; there is one '}' too many");
  EXPECT_EQ(error_in("HIERARCHY\nROOT A {\nOFFSET 0 1"),
            "3: :3:11: expected 3 numbers after OFFSET, but the file ends; the file may be cut "
            "off; export it again");
  EXPECT_EQ(error_in("HIERARCHY\nROOT A {\nOFFSET 0 1 0\n"),
            "4: :4:1: the file ends inside joint \"A\" of line 2: 1 '}' are missing; the file may "
            "be cut off; export it again");
  EXPECT_EQ(error_in("HIERARCHY ROOT A }"),
            "1: :1:18: expected a name and '{', got '}'; check the braces before it");
  EXPECT_EQ(error_in("HIERARCHY ROOT A\nOFFSET"),
            "2: :2:1: expected '{' after joint \"A\", got \"OFFSET\"; check the braces before it");
  EXPECT_EQ(error_in("HIERARCHY JOINT A { }"),
            "1: :1:11: expected ROOT or MOTION, got \"JOINT\"; check the braces before it");
  EXPECT_EQ(error_in("HIERARCHY ROOT A { ROOT B {"),
            "1: :1:20: expected OFFSET, CHANNELS, JOINT, End Site or '}' in joint \"A\", got "
            "\"ROOT\"; check the braces before it");
  EXPECT_EQ(
      error_with("End Site { OFFSET 0 1 0 }", "End Site { JOINT C { } }"),
      "8: :8:16: expected OFFSET or '}' in an End Site, got \"JOINT\"; check the braces before it");
}

TEST(ReadBvhRefuses, TreesBeyondTheLimits) {
  for (const int depth : {2000, 100'000}) {
    std::string text = "HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 0\n";
    for (int i = 1; i < depth; ++i) text += "JOINT j { OFFSET 0 1 0 CHANNELS 0\n";
    EXPECT_EQ(
        error_in(text),
        "257: :257:1: joints are nested deeper than 256; raise the limit max_depth if that is "
        "intended");
  }
  std::string siblings = "HIERARCHY ROOT r { OFFSET 0 0 0 CHANNELS 0\n";
  for (int i = 0; i < 5000; ++i) siblings += "JOINT j { OFFSET 0 1 0 CHANNELS 0 }\n";
  EXPECT_EQ(error_in(siblings),
            "1025: :1025:1: there are more than 1024 joints; raise the limit max_joints if that is "
            "intended");
}

TEST(ReadBvhRefuses, MissingMotion) {
  EXPECT_EQ(error_in(kFile.substr(0, kFile.find("MOTION"))),
            "11: :11:1: there is no MOTION section; the file may be cut off; export it again");
  EXPECT_EQ(error_in(kFile.substr(0, kFile.find("Frames"))),
            "12: :12:1: expected 'Frames:' and a number, but the file ends; MOTION is followed by "
            "'Frames: 12' and 'Frame Time: 0.01'");
  EXPECT_EQ(error_in(kFile.substr(0, kFile.find("1 2 3 4"))),
            "12: :12:1: the file has no frames; export the frames, or read only "
            "the skeleton");
  EXPECT_EQ(error_in(replaced(kFile.substr(0, kFile.find("1 2 3 4")), "Frames: 2", "Frames: 0")),
            "12: :12:1: the file has no frames; export the frames, or read only "
            "the skeleton");
  EXPECT_EQ(error_in("HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 0 }\nMOTION\nFrames: 3000000\n"
                     "Frame Time: 0.1"),
            "3: :3:1: no joint has a channel; export the joints with their "
            "channels");
}

TEST(ReadBvhRefuses, BadFrameCounts) {
  for (const char* frames : {"-5", "2.5"})
    EXPECT_EQ(
        error_with("Frames: 2", "Frames: "s + frames),
        "12: :12:1: the number of frames must be a whole number, 0 or more; count the rows below");
  EXPECT_EQ(error_with("Frames: 2", "Frames: 99999999999"),
            "12: :12:1: the file declares more frames than the limit of 3000000; raise the limit "
            "max_frames if that is intended");
  EXPECT_EQ(error_with("Frames: 2", "Frames: nan"),
            "12: :12:9: expected 'Frames:' and a number, got \"nan\"; write a decimal number such "
            "as -1.5");
  EXPECT_EQ(error_in(kFile, {.max_frames = 1}),
            "12: :12:1: the file declares more frames than the limit of 1; raise the limit "
            "max_frames if that is intended");
  EXPECT_EQ(error_in(replaced(kFile, "Frames: 2", "Frames: 1"), {.max_frames = 1}),
            "15: :15:15: there are more frames than the limit of 1; raise the limit max_frames if "
            "that is intended");
  EXPECT_EQ(error_in(replaced(kFile, "Frames: 2", "Frames: 1"), {.max_rotations = 2}),
            "15: :15:15: there are more frames than the limit of 1; raise the limit max_frames if "
            "that is intended");
}

TEST(ReadBvhRefuses, BadFrameTimes) {
  for (const char* time : {"-0.1", "1e-09", "2e+04"})
    EXPECT_EQ(error_with("Frame Time: 0.1", "Frame Time: "s + time),
              "13: :13:1: the frame time is "s + time +
                  " s, it must be from 0.0001 to 1 s; write the seconds between two frames");
  EXPECT_EQ(error_with("Frame Time: 0.1", "Frame Time: 40"),
            "13: :13:1: the frame time is 40 s, it must be from 0.0001 to 1 s; write the seconds "
            "between two frames: 40 frames per second are 0.025 s, 40 ms are 0.04 s");
  EXPECT_EQ(error_with("Frame Time: 0.1", "Frame Time: nan"),
            "13: :13:13: expected 'Frame Time:' and a number, got \"nan\"; write a decimal number "
            "such as -1.5");
  EXPECT_EQ(error_with("Frame Time: 0.1\n", ""),
            "13: :13:1: expected 'Frame Time:' and a number, got \"1\"; MOTION is followed by "
            "'Frames: 12' and 'Frame Time: 0.01'");
}

TEST(ReadBvhRefuses, RowsOfTheWrongLength) {
  EXPECT_EQ(error_with("1 2 3 4 5 6\n", "1 2 3 4 5\n"),
            "14: :14:10: the row of frame 1 has 5 values, expected 6; compare the row with the "
            "joints' CHANNELS");
  EXPECT_EQ(error_with("7 8 9 10 11 12", "7 8 9 10 11"),
            "15: :15:12: the row of frame 2 has 5 values, expected 6; the file may be cut off");
  EXPECT_EQ(error_with("1 2 3 4 5 6\n", "1 2 3 4 5 6 7\n"),
            "14: :14:13: the row of frame 1 has more values, expected 6; compare the row with the "
            "joints' CHANNELS");
}

TEST(ReadBvhRefuses, BadNumbers) {
  for (const char* number : {"nan", "inf", "0x1A", "--5", "1e", "x"})
    EXPECT_EQ(error_with("1 2 3 4 5 6", "1 2 3 "s + number + " 5 6"),
              "14: :14:7: expected a number, got \""s + number +
                  "\"; write a decimal number such as -1.5");
  EXPECT_EQ(
      error_with("1 2 3 4 5 6", "1 2 3 1,5 5 6"),
      "14: :14:7: expected a number, got \"1,5\"; it has a decimal comma; write numbers with a "
      "point");
  EXPECT_EQ(error_with("1 2 3 4 5 6", "1 2 3 1e400 5 6"),
            "14: :14:7: \"1e400\" is too large; check the number");
  EXPECT_EQ(error_with("1 2 3 4 5 6", "1 2 3 +1.5 1e-400 6"), "");
  std::string positions = replaced(kFile, "3 Zrotation Xrotation", "3 Xposition Xrotation");
  EXPECT_EQ(error_in(replaced(positions, "1 2 3", "1e30 2 3")),
            "14: :14:15: a position in the row of frame 1 is out of range; check the "
            "number and the unit of the file");
}

TEST(ReadBvhRefuses, WhatIsNoFile) {
  const TemporaryFolder folder;
  const auto error_at = [](const std::filesystem::path& path, const ReadOptions& options = {}) {
    return testing::error_of([&] { read_bvh(path, options); });
  };
  EXPECT_TRUE(testing::contains(error_at(folder / "none.bvh"), "no such file"));
  EXPECT_TRUE(testing::contains(error_at(folder.path()), "is a folder"));
  EXPECT_TRUE(testing::contains(error_at("/dev/zero"), "not a regular file"));
  EXPECT_TRUE(testing::contains(error_at(folder.write("a.bvh", kFile), {.max_bytes = 100}),
                                "more than the limit of 100"));
}

TEST(ReadBvhRefuses, OptionsOutOfRange) {
  EXPECT_REFUSED(ConfigError, "max_joints", read_bvh("a.bvh", {.max_joints = 0}));
  EXPECT_REFUSED(ConfigError, "max_depth", read_bvh("a.bvh", {.max_depth = 0}));
  EXPECT_REFUSED(ConfigError, "max_frames", read_bvh("a.bvh", {.max_frames = -1}));
  EXPECT_REFUSED(ConfigError, "unit_m", read_bvh("a.bvh", {.unit_m = 0.0}));
  EXPECT_REFUSED(ConfigError, "unit_m", read_bvh("a.bvh", {.unit_m = std::nan("")}));
}

// Cut anywhere, a file is refused or, where the cut leaves a whole file, read.
TEST(ReadBvhRefuses, EveryTruncation) {
  const TemporaryFolder folder;
  const auto path = folder / "cut.bvh";
  const auto first_row_end = kFile.find("7 8 9");
  for (std::size_t length = 0; length < kFile.size(); ++length) {
    folder.write("cut.bvh", kFile.substr(0, length));
    const bool holds_whole_rows =
        (length >= first_row_end - 1 && length <= first_row_end) || length >= kFile.size() - 2;
    EXPECT_EQ(testing::error_of([&] { read_bvh(path); }).empty(), holds_whole_rows)
        << length << ": " << kFile.substr(0, length);
  }
}

}  // namespace
}  // namespace sparse_mocap
