// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/bvh.hpp"

namespace sparse_mocap {
namespace {

using testing::TemporaryFolder;

std::string written(const Motion& motion) {
  const TemporaryFolder folder;
  write_bvh(folder / "out.bvh", motion);
  std::ifstream file(folder / "out.bvh", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Motion written_and_read(const Motion& motion) {
  const TemporaryFolder folder;
  write_bvh(folder / "out.bvh", motion);
  return read_bvh(folder / "out.bvh").motion;
}

Joint joint(const std::string& name, int parent, const Vec3& offset, const Vec3& bone) {
  Joint result;
  result.name = name;
  result.parent = parent;
  result.offset_parent = offset;
  result.bone = bone;
  return result;
}

// A tree with bones and offsets, a fork and leaves with and without a bone, and a joint that moves.
Motion random_motion(int num_frames) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  Motion motion;
  motion.skeleton = Skeleton({joint("pelvis", -1, Vec3::Zero(), 0.1 * vector()),
                              joint("spine", 0, 0.2 * vector(), 0.3 * vector()),
                              joint("left arm", 1, 0.2 * vector(), Vec3::Zero()),
                              joint("left {hand}", 2, 0.3 * vector(), 0.1 * vector()),
                              joint("right", 1, Vec3::Zero(), 0.4 * vector()),
                              joint("tail", 0, 0.1 * vector(), Vec3::Zero())});
  motion.frame_time_s = 1.0 / 120.0;
  motion.offset_tracks.push_back({4, {}});
  for (int frame = 0; frame < num_frames; ++frame) {
    motion.root_positions.push_back(3.0 * vector());
    motion.offset_tracks[0].offset_parent.push_back(vector());
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      motion.rotations.push_back(
          Quat(normal(random), normal(random), normal(random), normal(random)).normalized());
  }
  return motion;
}

TEST(WriteBvh, WritesWhatTheFormatAsksFor) {
  Motion motion;
  motion.skeleton = Skeleton({joint("root", -1, Vec3::Zero(), Vec3(0, 0.5, 0)),
                              joint("left arm", 0, Vec3(0.25, 0, 0), Vec3(0, 0, 0.125))});
  motion.frame_time_s = 0.025;
  motion.root_positions = {Vec3(1, 2, 3)};
  motion.rotations = {Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ())), Quat::Identity()};
  EXPECT_EQ(written(motion),
            "HIERARCHY\n"
            "ROOT root\n"
            "{\n"
            "\tOFFSET 0.000000 0.000000 0.000000\n"
            "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
            "\tJOINT left_arm\n"
            "\t{\n"
            "\t\tOFFSET 25.000000 50.000000 0.000000\n"
            "\t\tCHANNELS 3 Zrotation Yrotation Xrotation\n"
            "\t\tEnd Site\n"
            "\t\t{\n"
            "\t\t\tOFFSET 0.000000 0.000000 12.500000\n"
            "\t\t}\n"
            "\t}\n"
            "}\n"
            "MOTION\n"
            "Frames: 1\n"
            "Frame Time: 0.025\n"
            "100.000000 200.000000 300.000000 90.000000 0.000000 0.000000 0.000000 0.000000 "
            "0.000000\n");
}

TEST(WriteBvh, ARoundTripKeepsEveryJoint) {
  const auto motion = random_motion(50);
  const auto again = written_and_read(motion);
  ASSERT_EQ(again.num_frames(), 50);
  EXPECT_EQ(again.frame_time_s, motion.frame_time_s);
  EXPECT_EQ(again.offset_tracks.size(), 1U);
  for (int frame = 0; frame < 50; ++frame) {
    const auto expected = motion.transforms(frame);
    const auto actual = again.transforms(frame);
    for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
      const auto& name = motion.skeleton.joint(j).name;
      auto written_name = name;
      for (char& c : written_name)
        if (c == ' ' || c == '{' || c == '}') c = '_';
      const int k = again.skeleton.find(written_name);
      ASSERT_GE(k, 0) << written_name;
      const auto from = static_cast<std::size_t>(j);
      const auto to = static_cast<std::size_t>(k);
      EXPECT_LT((actual.pivot[to] - expected.pivot[from]).norm(), 1e-6) << name;
      EXPECT_LT(again.rotation(frame, k).angularDistance(motion.rotation(frame, j)), 1e-6) << name;
      const bool is_leaf = j >= 3;
      if (is_leaf) {
        EXPECT_LT((actual.end[to] - expected.end[from]).norm(), 1e-6) << name;
      }
    }
  }
}

TEST(WriteBvh, ASecondRoundTripChangesNothing) {
  const auto once = written_and_read(random_motion(10));
  EXPECT_EQ(written(once), written(written_and_read(once)));
}

TEST(WriteBvh, AnglesAreContinuousAndRotationsExactAtTheGimbal) {
  // Spins about all axes, through y = 90 degrees, where ZYX angles are not unique.
  Motion motion;
  motion.skeleton = Skeleton({joint("root", -1, Vec3::Zero(), Vec3(0, 1, 0))});
  for (int frame = 0; frame <= 720; ++frame) {
    motion.root_positions.push_back(Vec3::Zero());
    motion.rotations.emplace_back(Eigen::AngleAxisd(frame * kRadiansPerDegree, Vec3::UnitY()) *
                                  Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  }
  const auto again = written_and_read(motion);
  for (int frame = 0; frame <= 720; ++frame)
    EXPECT_LT(again.rotation(frame, 0).angularDistance(motion.rotation(frame, 0)), 1e-6) << frame;

  for (int frame = 0; frame <= 720; ++frame)
    motion.rotations[static_cast<std::size_t>(frame)] =
        Quat(Eigen::AngleAxisd(frame * kRadiansPerDegree, Vec3::UnitZ()) *
             Eigen::AngleAxisd(0.5, Vec3::UnitY()) *
             Eigen::AngleAxisd(-2.0 * frame * kRadiansPerDegree, Vec3::UnitX()));
  std::istringstream rows(written(motion));
  std::string line;
  while (std::getline(rows, line) && !line.starts_with("Frame Time")) continue;
  double z = 0, y = 0, x = 0, ignored = 0;
  for (int frame = 0; frame <= 720; ++frame) {
    rows >> ignored >> ignored >> ignored >> z >> y >> x;
    EXPECT_NEAR(z, frame, 1e-5);
    EXPECT_NEAR(y, 0.5 / kRadiansPerDegree, 1e-5);
    EXPECT_NEAR(x, -2.0 * frame, 1e-5);
  }
}

TEST(WriteBvh, WritesAnAcclaimSkeletonWithItsBones) {
  Motion motion;
  auto bent = joint("upper", 0, Vec3::Zero(), Vec3(0, 0.4, 0));
  bent.R_joint_axes = Eigen::AngleAxisd(1.0, Vec3::UnitX()).toRotationMatrix();
  motion.skeleton = Skeleton({joint("root", -1, Vec3::Zero(), Vec3::Zero()), bent,
                              joint("lower", 1, Vec3::Zero(), Vec3(0, 0.3, 0))});
  motion.root_positions = {Vec3(0, 1, 0)};
  motion.rotations = {Quat::Identity(), Quat(Eigen::AngleAxisd(0.7, Vec3::UnitZ())),
                      Quat(Eigen::AngleAxisd(-0.2, Vec3::UnitX()))};
  const auto again = written_and_read(motion).transforms(0);
  const auto expected = motion.transforms(0);
  EXPECT_LT((again.pivot[2] - expected.end[1]).norm(), 1e-6);
  EXPECT_LT((again.end[2] - expected.end[2]).norm(), 1e-6);
}

TEST(WriteBvh, FailsWhereItCannotWrite) {
  EXPECT_THROW(write_bvh("/nonexistent/folder/out.bvh", random_motion(1)),
               std::filesystem::filesystem_error);
}

}  // namespace
}  // namespace sparse_mocap
