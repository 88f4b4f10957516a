// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/acclaim_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formats/acclaim_test_files.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/formats/bvh.hpp"

namespace sparse_mocap {
namespace {

using testing::kAmc;
using testing::kAsf;
using testing::read_acclaim_text;
using testing::replaced;
using testing::TemporaryFolder;

struct Texts {
  std::string asf, amc;
};

Texts written(const Motion& motion) {
  const TemporaryFolder folder;
  write_acclaim(folder / "out.amc", motion);
  return {read_file(folder / "out.asf", 1 << 20), read_file(folder / "out.amc", 1 << 20)};
}

MotionFile written_and_read(const Motion& motion) {
  const auto texts = written(motion);
  return read_acclaim_text(texts.asf, texts.amc);
}

Motion read_bvh_text(const std::string& text) {
  const TemporaryFolder folder;
  return read_bvh(folder.write("walk.bvh", text), {.unit_m = 1.0}).motion;
}

// Joints of the same name (the roots are one) have the same pivots and rotations in every frame,
// and those with a bone the same ends.
void expect_same_places(const Motion& actual, const Motion& expected) {
  ASSERT_EQ(actual.num_frames(), expected.num_frames());
  EXPECT_NEAR(actual.frame_time_s, expected.frame_time_s, 1e-12);
  for (int frame = 0; frame < expected.num_frames(); ++frame) {
    const auto from = expected.transforms(frame);
    const auto to = actual.transforms(frame);
    for (int j = 0; j < expected.skeleton.num_joints(); ++j) {
      const auto& name = expected.skeleton.joint(j).name;
      const int found = j == 0 ? 0 : actual.skeleton.find(name);
      ASSERT_GE(found, 0) << name;
      const auto a = static_cast<std::size_t>(found);
      const auto b = static_cast<std::size_t>(j);
      EXPECT_LT((to.pivot[a] - from.pivot[b]).norm(), 1e-6) << name;
      if (j > 0 && !expected.skeleton.joint(j).bone.isZero(0.0)) {
        EXPECT_LT((to.end[a] - from.end[b]).norm(), 1e-6) << name;
      }
      EXPECT_LT((to.R_world_joint[a] - from.R_world_joint[b]).norm(), 1e-6) << name;
    }
  }
}

void expect_same_skeleton(const Skeleton& actual, const Skeleton& expected) {
  ASSERT_EQ(actual.num_joints(), expected.num_joints());
  for (int j = 0; j < expected.num_joints(); ++j) {
    const auto& a = actual.joint(j);
    const auto& b = expected.joint(j);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.axes, b.axes) << a.name;
    EXPECT_LT((a.bone - b.bone).norm(), 1e-10) << a.name;
    EXPECT_LT((a.R_joint_axes - b.R_joint_axes).norm(), 1e-10) << a.name;
  }
}

TEST(WriteAcclaim, WritesWhatTheFormatAsksFor) {
  const auto amc = replaced(kAmc, "thigh 90 90 0", "thigh 90 45 0");
  const auto texts = written(read_acclaim_text(kAsf, amc).motion);
  EXPECT_EQ(texts.amc,
            "#!OML:ASF\n:FULLY-SPECIFIED\n:SAMPLES-PER-SECOND 120\n:DEGREES\n"
            "1\nroot 17.716535 35.433071 53.149606 0 0 0\nthigh 0 0 0\nshin 0\n"
            "2\nroot 17.716535 35.433071 53.149606 0 0 90\nthigh 90 45 0\nshin 90\n");
  EXPECT_TRUE(testing::contains(texts.asf,
                                "    id 1\n    name thigh\n    direction 0 -1 0\n"
                                "    length 8.85826771654\n    axis 0 0 0 XYZ\n    dof rx ry rz\n"
                                "    limits (-inf inf)\n           (-inf inf)\n"
                                "           (-inf inf)\n  end\n"));
  EXPECT_TRUE(testing::contains(texts.asf, "  begin\n    root thigh\n    thigh shin fin\n  end\n"));
  EXPECT_TRUE(testing::contains(texts.asf, "order TX TY TZ RX RY RZ\n"));
}

TEST(WriteAcclaim, AnAcclaimMotionComesBackWithItsAxesAndDof) {
  auto asf = replaced(kAsf, "orientation 0 0 0", "orientation 20 30 40");
  asf = replaced(asf, "order TX TY TZ RX RY RZ", "order TX TY TZ RZ RY RX");
  asf = replaced(asf, "axis 0 0 0 XYZ", "axis 10 -70 200 ZXY");
  asf = replaced(asf, "direction 0 -1 0", "direction 0.6 -0.64 0.48");
  asf = replaced(asf, "dof rx ry rz", "dof rz rx");
  asf = replaced(asf, "           (-inf inf)\n", "");
  auto amc = replaced(kAmc, "thigh 0 0 0", "thigh 10 20");
  amc = replaced(amc, "thigh 90 90 0", "thigh 120.5 -33");
  amc = replaced(amc, "root 1 2 3 0 0 0", "root 1 2 3 10 20 30");
  const auto file = read_acclaim_text(asf, amc);
  const auto again = written_and_read(file.motion);
  EXPECT_TRUE(again.warnings.empty());
  expect_same_skeleton(again.motion.skeleton, file.motion.skeleton);
  expect_same_places(again.motion, file.motion);
  const auto rows = written(file.motion).amc;
  EXPECT_TRUE(testing::contains(rows, " 10 20 30\nthigh 10 20\nshin 0\n")) << rows;
  EXPECT_TRUE(testing::contains(rows, "\nthigh 120.5 -33\nshin 90\n")) << rows;
}

TEST(WriteAcclaim, TranslationsOfBonesComeBack) {
  auto asf = replaced(kAsf, "dof rx\n    limits (0 0)\n", "dof tx ty tz rx\n");
  asf = replaced(asf, "length 0.4\n    axis 0 0 0", "length 0.4\n    axis 0 0 90");
  auto amc = replaced(kAmc, "shin 0\n", "shin 0 0 0 0\n");
  amc = replaced(amc, "shin 90\n", "shin 0.1 0.2 0.3 0\n");
  const auto file = read_acclaim_text(asf, amc);
  const auto again = written_and_read(file.motion);
  expect_same_skeleton(again.motion.skeleton, file.motion.skeleton);
  expect_same_places(again.motion, file.motion);
  ASSERT_EQ(again.motion.offset_tracks.size(), 1U);
}

const std::string kBvh =
    "HIERARCHY\nROOT Hips {\nOFFSET 7 8 9\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
    "Xrotation Yrotation\n"
    "JOINT Spine {\nOFFSET 0.1 0.5 0\nCHANNELS 3 Yrotation Xrotation Zrotation\n"
    "End Site { OFFSET 0 0.3 0.1 } }\n"
    "JOINT Leg {\nOFFSET 0.2 -0.1 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\nJOINT Foot {\nOFFSET 0 -0.4 0\nCHANNELS 1 Xrotation } }\n"
    "JOINT Still {\nOFFSET 0 0 0\nCHANNELS 0 }\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.0125\n"
    "1 2 3 10 20 30 40 50 60 0.2 -0.1 0 70 80 90 15\n"
    "4 5 6 -170 80 179 -40 85 -60 0.3 -0.2 0.1 -70 -89 100 -15\n";

TEST(WriteAcclaim, ABvhMotionComesBackWithABoneForEveryOffset) {
  const auto motion = read_bvh_text(kBvh);
  const auto again = written_and_read(motion).motion;
  expect_same_places(again, motion);
  const auto& skeleton = again.skeleton;
  EXPECT_EQ(skeleton.num_joints(), 7);
  EXPECT_EQ(skeleton.joint(skeleton.find("Spine")).parent, skeleton.find("Spine_offset"));
  EXPECT_EQ(skeleton.joint(skeleton.find("Foot")).parent, skeleton.find("Leg"));
  EXPECT_TRUE(skeleton.joint(skeleton.find("Leg")).bone.isApprox(Vec3(0, -0.4, 0)));
  EXPECT_EQ(skeleton.joint(skeleton.find("Still")).parent, 0);
  EXPECT_TRUE(skeleton.joint(skeleton.find("Still")).axes.empty());
  EXPECT_EQ(skeleton.joint(skeleton.find("Foot")).axes, std::vector<Axis>{Axis::x});
  EXPECT_EQ(again.offset_tracks.size(), 1U);
  expect_same_skeleton(written_and_read(again).motion.skeleton, skeleton);
}

TEST(WriteAcclaim, AJointWithSeveralChildrenReachesToTheFirst) {
  const auto motion = read_bvh_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation JOINT B { OFFSET 0 1 0 CHANNELS 3 "
      "Zrotation Yrotation Xrotation JOINT C { OFFSET 0 0 0 CHANNELS 1 Yrotation } JOINT D { "
      "OFFSET 0.1 0.2 0.3 CHANNELS 1 Yrotation } JOINT E { OFFSET 0.3 0.2 0.5 CHANNELS 1 Yrotation "
      "} } }\nMOTION Frames: 1 Frame Time: 0.1\n90 10 20 30 40 50 60");
  const auto again = written_and_read(motion).motion;
  expect_same_places(again, motion);
  const auto bone_of = [&](const std::string& name) {
    return again.skeleton.joint(again.skeleton.find(name)).bone;
  };
  EXPECT_TRUE(bone_of("B").isApprox(Vec3(0.1, 0.2, 0.3)));
  EXPECT_TRUE(bone_of("C_offset").isApprox(Vec3(-0.1, -0.2, -0.3)));
  EXPECT_EQ(again.skeleton.find("D_offset"), -1);
  EXPECT_TRUE(bone_of("E_offset").isApprox(Vec3(0.2, 0, 0.2)));
}

TEST(WriteAcclaim, ABoneOfTheRootBecomesAFixedBone) {
  const auto motion = read_bvh_text(
      "HIERARCHY ROOT A { OFFSET 0 0 0 CHANNELS 1 Xrotation End Site { OFFSET 0 1 0 } }\n"
      "MOTION Frames: 1 Frame Time: 0.1\n90");
  const auto again = written_and_read(motion).motion;
  EXPECT_EQ(again.skeleton.joint(1).name, "root_bone");
  EXPECT_LT((again.transforms(0).end[1] - motion.transforms(0).end[0]).norm(), 1e-9);
}

// A tree with everything at once, in a skeleton that no file gives.
TEST(WriteAcclaim, ARandomMotionComesBack) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  const auto rotation = [&] {
    return Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  };
  std::vector<Joint> joints;
  for (int j = 0; j < 12; ++j) {
    Joint joint;
    joint.name = "j" + std::to_string(j);
    joint.parent = j == 0 ? -1 : std::uniform_int_distribution<int>(0, j - 1)(random);
    joint.R_joint_axes = rotation().toRotationMatrix();
    if (j % 2 == 1) joint.offset_parent = vector();
    if (j % 3 != 0) joint.bone = vector();
    if (j % 4 == 0) joint.axes = {Axis::y, Axis::z, Axis::x};
    if (j % 4 == 1) joint.axes = {Axis::y};  // the rotations below are beyond it
    joints.push_back(std::move(joint));
  }
  Motion motion;
  motion.skeleton = Skeleton(std::move(joints));
  motion.frame_time_s = 0.04;
  motion.offset_tracks.push_back({5, {}});
  for (int frame = 0; frame < 20; ++frame) {
    motion.root_positions.push_back(vector());
    motion.offset_tracks[0].offset_parent.push_back(vector());
    for (int j = 0; j < 12; ++j) motion.rotations.push_back(rotation());
  }
  const auto again = written_and_read(motion).motion;
  expect_same_places(again, motion);
  const auto texts = written(again);
  const auto third = read_acclaim_text(texts.asf, texts.amc).motion;
  EXPECT_EQ(written(third).amc, texts.amc) << "a second round trip changes no row";
}

TEST(WriteAcclaim, NamesAreMadeWritable) {
  std::vector<Joint> joints(7);
  const std::vector<std::string> names{"Hips", "left arm", "Root", "LEFT_ARM",
                                       "1e5",  "#a,(b)",   ":a:b"};
  for (std::size_t j = 0; j < names.size(); ++j) {
    joints[j].name = names[j];
    joints[j].parent = static_cast<int>(j) - 1;
  }
  Motion motion;
  motion.skeleton = Skeleton(std::move(joints));
  motion.root_positions.assign(1, Vec3::Zero());
  motion.rotations.assign(7, Quat::Identity());
  const auto again = written_and_read(motion).motion;
  std::vector<std::string> found;
  for (const auto& joint : again.skeleton.joints()) found.push_back(joint.name);
  EXPECT_EQ(found, (std::vector<std::string>{"root", "left_arm", "Root_2", "LEFT_ARM_2", "_1e5",
                                             "_a__b_", "_a:b"}));
}

TEST(WriteAcclaimRefuses, WhatTheFormatCannotHold) {
  const TemporaryFolder folder;
  const auto path = folder / "out.amc";
  const auto error = [&](const Motion& motion) {
    return testing::error_of([&] { write_acclaim(path, motion); });
  };
  const auto good = read_acclaim_text(kAsf, kAmc).motion;
  EXPECT_EQ(error({}),
            "0: : cannot be written as Acclaim: the motion has no joints; give it a "
            "skeleton");
  auto bad = good;
  bad.frame_time_s = 2.0;
  EXPECT_TRUE(testing::contains(error(bad), "a frame time of 2.000000 s, which must be from"));
  bad = good;
  bad.rotation(1, 2).x() = std::nan("");
  EXPECT_TRUE(testing::contains(error(bad), "not finite"));
  bad = good;
  bad.root_positions[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(testing::contains(error(bad), "not finite"));
  bad.root_positions[0].x() = 1e6;
  EXPECT_TRUE(testing::contains(error(bad), "beyond 100 km"));
  EXPECT_FALSE(std::filesystem::exists(path) || std::filesystem::exists(folder / "out.asf"));
  EXPECT_THROW(write_acclaim(folder / "none" / "out.amc", good), std::filesystem::filesystem_error);
}

}  // namespace
}  // namespace sparse_mocap
