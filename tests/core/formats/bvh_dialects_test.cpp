// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ways in which the exporters of the world differ, each with the numbers that it means.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/format_test_support.hpp"
#include "formats/textbook_rotations.hpp"
#include "sparse_mocap/formats/bvh.hpp"

namespace sparse_mocap {
namespace {

using testing::has_warning;
using testing::kOrders;
using testing::matrix_of;
using testing::TemporaryFolder;

MotionFile read_text(const std::string& text, ReadOptions options = {.unit_m = 1.0}) {
  const TemporaryFolder folder;
  return testing::sound(read_bvh(folder.write("walk.bvh", text), options));
}

// A chain of six joints, 1 m apart along y; joint i turns in the i-th order by the textbook angles.
// Every joint has the channels that `channels` makes of its order, and `row` its values.
template <typename Channels>
std::string chain(const Channels& channels, const std::string& values) {
  std::string text = "HIERARCHY\n";
  std::string row;
  for (std::size_t i = 0; i < kOrders.size(); ++i) {
    text += (i == 0 ? "ROOT j" : "JOINT j") + std::to_string(i) + " {\nOFFSET 0 1 0\nCHANNELS " +
            channels(std::string(kOrders[i].name)) + "\n";
    row += values + " ";
  }
  for (std::size_t i = 0; i < kOrders.size(); ++i) text += "}\n";
  return text + "MOTION\nFrames: 1\nFrame Time: 0.01\n" + row + "\n";
}

// Where the joints of the chain are, from the textbook matrices alone.
std::vector<Vec3> chain_positions(const Vec3& first, const Vec3& offset) {
  std::vector<Vec3> positions{first};
  Mat3 R = Mat3::Identity();
  for (std::size_t i = 0; i + 1 < kOrders.size(); ++i) {
    R = R * matrix_of(kOrders[i]);
    positions.push_back(positions.back() + R * offset);
  }
  return positions;
}

void expect_positions(const MotionFile& file, const std::vector<Vec3>& expected) {
  const auto pose = file.motion.transforms(0);
  ASSERT_EQ(pose.pivot.size(), expected.size());
  for (std::size_t j = 0; j < expected.size(); ++j)
    EXPECT_LT((pose.pivot[j] - expected[j]).norm(), 1e-13) << j;
}

std::string rotations(const std::string& order) {
  std::string names;
  for (const char letter : order) names += std::string(" ") + letter + "rotation";
  return names;
}

TEST(ReadBvhDialects, AnotherOrderOnEveryJoint) {
  const auto file = read_text(
      chain([](const std::string& order) { return "3" + rotations(order); }, testing::kAngles));
  expect_positions(file, chain_positions(Vec3(0, 1, 0), Vec3(0, 1, 0)));
}

TEST(ReadBvhDialects, SixChannelsOnEveryJoint) {
  // The positions, here the OFFSETs once more, make no track; others replace the OFFSET.
  const auto before = [](const std::string& order) {
    return "6 Xposition Yposition Zposition" + rotations(order);
  };
  const auto still = read_text(chain(before, "0 1 0 " + testing::kAngles));
  EXPECT_TRUE(still.motion.offset_tracks.empty());
  expect_positions(still, chain_positions(Vec3(0, 1, 0), Vec3(0, 1, 0)));
  const auto moved = read_text(chain(before, "3 4 5 " + testing::kAngles));
  EXPECT_EQ(moved.motion.offset_tracks.size(), 5U);
  expect_positions(moved, chain_positions(Vec3(3, 4, 5), Vec3(3, 4, 5)));
}

TEST(ReadBvhDialects, PositionsAfterTheRotations) {
  const auto after = [](const std::string& order) {
    return "6" + rotations(order) + " Zposition Xposition Yposition";
  };
  const auto file = read_text(chain(after, testing::kAngles + " 5 3 4"));
  expect_positions(file, chain_positions(Vec3(3, 4, 5), Vec3(3, 4, 5)));
}

TEST(ReadBvhDialects, OnePositionChannelReplacesOneNumberOfTheOffset) {
  const auto height = [](const std::string& order) { return "4 Zposition" + rotations(order); };
  const auto file = read_text(chain(height, "0.5 " + testing::kAngles));
  expect_positions(file, chain_positions(Vec3(0, 1, 0.5), Vec3(0, 1, 0.5)));
}

const std::string kNoEndSites =
    "HIERARCHY\nROOT mixamorig:Hips {\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
    "JOINT mixamorig:Spine {\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n}\n}\n"
    "MOTION\nFrames: 1\nFrame Time: 0.01\n";

TEST(ReadBvhDialects, NoEndSitesAndNamesWithColons) {
  const auto file = read_text(kNoEndSites + "90 0 0 0 0 0\n");
  EXPECT_EQ(file.motion.skeleton.find("mixamorig:Hips"), 0);
  EXPECT_EQ(file.motion.skeleton.find("mixamorig:Spine"), 1);
  EXPECT_EQ(file.motion.skeleton.joint(1).bone, Vec3(0, 0, 0));
  EXPECT_LT((file.motion.transforms(0).end[1] - Vec3(-1, 0, 0)).norm(), 1e-13);
  EXPECT_TRUE(file.warnings.empty());
}

TEST(ReadBvhDialects, NumbersOfEveryPrinter) {
  for (const char* quarter : {"9e001", "9.0E+001", "+90", "90.", ".9e2", "900000e-004", "0090"}) {
    const auto file = read_text(kNoEndSites + quarter + " -.0 1e-300 -0 0.e0 +.0\n");
    EXPECT_LT((file.motion.transforms(0).end[1] - Vec3(-1, 0, 0)).norm(), 1e-13) << quarter;
  }
}

TEST(ReadBvhDialects, WarningsOfAKindAreCounted) {
  std::string text = "HIERARCHY ROOT a {\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 20; ++i)
    text += "JOINT my arm {\nOFFSET 0 0 0\nCHANNELS 0\nEnd Site { }\n}\n";
  const auto file = read_text(text + "}\nMOTION\nFrames: 3\nFrame Time: 0.1\n0\n");
  ASSERT_EQ(file.warnings.size(), 4U);
  EXPECT_TRUE(has_warning(file, "a name with spaces"));
  EXPECT_EQ(file.warnings[0].count, 20);
  EXPECT_EQ(file.warnings[0].location.line, 4);
  EXPECT_TRUE(file.warnings[0].message().ends_with(
      ":4:1: a name with spaces; read as \"my_arm\" (and 19 more of this kind)"));
  EXPECT_TRUE(has_warning(file, "End Site without OFFSET"));
  EXPECT_EQ(file.warnings[1].count, 20);
  EXPECT_TRUE(has_warning(file, "a second joint named"));
  EXPECT_EQ(file.warnings[2].count, 19);
  EXPECT_EQ(file.warnings[3].count, 1);
  EXPECT_TRUE(file.warnings[3].message().ends_with("all that exist are read"));
}

}  // namespace
}  // namespace sparse_mocap
