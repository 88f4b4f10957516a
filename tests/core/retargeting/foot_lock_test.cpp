// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/foot_lock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "retargeting/synthetic_body.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {
namespace {

using testing::turn;
using testing::walk;

constexpr double kAnkle_m = 0.08;

std::size_t index_of(const Motion& motion, const char* name) {
  return static_cast<std::size_t>(motion.skeleton.find(name));
}

// Two seconds of a person who stands with bent knees, swaying by 5 cm, so that the feet slide.
Motion sliding() {
  Motion motion = walk(testing::t_pose);
  Motion out = motion;
  out.rotations.clear();
  out.root_positions.clear();
  out.frame_time_s = 0.02;
  const int num_joints = motion.skeleton.num_joints();
  for (int t = 0; t < 100; ++t) {
    for (int j = 0; j < num_joints; ++j) out.rotations.push_back(Quat::Identity());
    const auto bend = [&](const char* name, double degrees) {
      out.rotation(t, motion.skeleton.find(name)) = Quat(turn(degrees, Vec3::UnitX()));
    };
    for (const char* thigh : {"LeftUpLeg", "RightUpLeg"}) bend(thigh, -15.0);
    for (const char* shank : {"LeftLeg", "RightLeg"}) bend(shank, 30.0);
    out.root_positions.emplace_back(0.05 * std::sin(0.1 * t), 0.0, 0.02 * std::sin(0.07 * t));
  }
  // The lowest ankle a little below where a flat foot has it.
  double lowest = 1e9;
  for (int t = 0; t < 100; ++t)
    lowest = std::min(lowest, out.transforms(t).pivot[index_of(out, "LeftFoot")].y());
  for (auto& position : out.root_positions) position.y() += kAnkle_m - 0.02 - lowest;
  return out;
}

LockedFeet locked(const Motion& motion, double strength) {
  const Eigen::Matrix2Xd contacts = Eigen::Matrix2Xd::Ones(2, motion.num_frames());
  FootLockOptions options;
  options.strength = strength;
  options.ankle_height_m = kAnkle_m;
  return lock_feet(motion, map_skeleton(motion.skeleton), contacts, options);
}

double largest_way(const Motion& motion, const char* joint) {
  const Vec3 first = motion.transforms(0).pivot[index_of(motion, joint)];
  double way = 0.0;
  for (int t = 0; t < motion.num_frames(); ++t)
    way = std::max(way, (motion.transforms(t).pivot[index_of(motion, joint)] - first).norm());
  return way;
}

TEST(FootLock, KeepsStandingFeetInOnePlaceAtTheirHeight) {
  const Motion motion = sliding();
  const LockedFeet found = locked(motion, 1.0);
  for (const char* foot : {"LeftFoot", "RightFoot"}) {
    EXPECT_GT(largest_way(motion, foot), 0.04);
    EXPECT_LT(largest_way(found.motion, foot), 1e-6);
    EXPECT_NEAR(found.motion.transforms(50).pivot[index_of(motion, foot)].y(), kAnkle_m, 1e-6);
  }
  ASSERT_EQ(found.stands[0].size(), 1u);
  EXPECT_EQ(found.stands[0][0].end - found.stands[0][0].begin, 100);
}

TEST(FootLock, LaysStandingFeetFlatAndLetsThemNotTurn) {
  const Motion motion = sliding();
  const LockedFeet found = locked(motion, 1.0);
  for (const char* foot : {"LeftFoot", "RightFoot"}) {
    const Mat3 first = found.motion.transforms(0).R_world_joint[index_of(motion, foot)];
    for (int t = 0; t < motion.num_frames(); ++t) {
      const Mat3 R = found.motion.transforms(t).R_world_joint[index_of(motion, foot)];
      EXPECT_NEAR((R * kUp).dot(kUp), 1.0, 1e-9);
      EXPECT_LT((R - first).norm(), 1e-6);
    }
  }
}

TEST(FootLock, LeavesEverythingElseAsItIs) {
  const Motion motion = sliding();
  const LockedFeet found = locked(motion, 1.0);
  for (const char* joint : {"LeftArm", "Spine", "Head", "RightHand"})
    for (int t = 0; t < motion.num_frames(); ++t) {
      const int j = motion.skeleton.find(joint);
      EXPECT_LT(found.motion.rotation(t, j).angularDistance(motion.rotation(t, j)), 1e-12);
    }
}

TEST(FootLock, DoesNothingWithoutStrength) {
  const Motion motion = sliding();
  const LockedFeet found = locked(motion, 0.0);
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      EXPECT_LT((found.motion.transforms(t).pivot[static_cast<std::size_t>(j)] -
                 motion.transforms(t).pivot[static_cast<std::size_t>(j)])
                    .norm(),
                1e-6);
}

TEST(FootLock, LowersThePelvisWhereALegIsTooShort) {
  Motion motion = sliding();
  for (auto& rotation : motion.rotations) rotation = Quat::Identity();  // straight legs
  const double ankle = motion.transforms(0).pivot[index_of(motion, "LeftFoot")].y();
  for (auto& position : motion.root_positions) position.y() += kAnkle_m + 0.03 - ankle;
  const LockedFeet found = locked(motion, 1.0);
  for (const char* foot : {"LeftFoot", "RightFoot"})
    EXPECT_LT(largest_way(found.motion, foot), 2e-3);
  EXPECT_LT(found.motion.root_positions[50].y(), motion.root_positions[50].y() - 0.02);
}

TEST(FootLock, LiftsToesOutOfTheFloor) {
  Motion motion = sliding();
  for (int t = 0; t < motion.num_frames(); ++t)
    motion.rotation(t, motion.skeleton.find("LeftFoot")) = Quat(turn(80.0, Vec3::UnitX()));
  const Eigen::Matrix2Xd none = Eigen::Matrix2Xd::Zero(2, motion.num_frames());
  FootLockOptions options;
  options.ankle_height_m = kAnkle_m;
  const LockedFeet found = lock_feet(motion, map_skeleton(motion.skeleton), none, options);
  EXPECT_TRUE(found.stands[0].empty());
  const auto toes = index_of(motion, "LeftToes");
  EXPECT_LT(motion.transforms(20).pivot[toes].y(), -0.02);
  for (int t = 0; t < motion.num_frames(); ++t)
    EXPECT_GT(found.motion.transforms(t).pivot[toes].y(), -1e-6);
}

TEST(FootLock, ReturnsARigWithoutFeetAsItIsAndRefusesWhatDoesNotFit) {
  Motion bare;
  bare.skeleton = make_standard_skeleton(template_bones());
  bare.root_positions.assign(3, Vec3::Zero());
  bare.rotations.assign(3 * bare.skeleton.joints().size(), Quat::Identity());
  const SkeletonMapping mapping = map_skeleton(bare.skeleton);
  const LockedFeet found = lock_feet(bare, mapping, Eigen::Matrix2Xd::Ones(2, 3), {});
  EXPECT_EQ(found.motion.num_frames(), 3);
  EXPECT_TRUE(found.stands[0].empty());
  EXPECT_THROW(lock_feet(bare, mapping, Eigen::Matrix2Xd::Ones(2, 4), {}), std::invalid_argument);
  EXPECT_THROW(lock_feet(sliding(), mapping, Eigen::Matrix2Xd::Ones(2, 100), {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace sparse_mocap
