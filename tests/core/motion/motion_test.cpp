// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;
using testing::resting_motion;
using testing::swaying_motion;
using testing::template_skeleton;

Vec3 in_mirror(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

// A standard body whose sides differ, so that a mistaken side shows.
Skeleton lopsided_skeleton() {
  StandardBones bones = template_bones();
  Random random(9);
  for (auto& bone : bones) bone += random.vector(0.03);
  return make_standard_skeleton(bones);
}

Motion with_offset_track(Motion motion) {
  Random random(10);
  OffsetTrack track{standard_joint::lfemur, {}};
  for (int t = 0; t < motion.num_frames(); ++t) track.offset_parent.push_back(random.vector(0.1));
  motion.offset_tracks.push_back(track);
  return motion;
}

double worst_distance(const JointTransforms& a, const JointTransforms& b) {
  double worst = 0.0;
  for (std::size_t j = 0; j < a.end.size(); ++j)
    worst = std::max({worst, (a.end[j] - b.end[j]).norm(), (a.pivot[j] - b.pivot[j]).norm(),
                      (a.R_world_joint[j] - b.R_world_joint[j]).norm()});
  return worst;
}

TEST(Motion, PlacesOffsetTracksInTheirFrames) {
  Motion motion = with_offset_track(resting_motion(template_skeleton(), 4, 100.0));
  const auto plain = resting_motion(template_skeleton(), 4, 100.0).transforms(0);
  for (int t = 0; t < 4; ++t) {
    const auto at = motion.transforms(t);
    const Vec3 moved = motion.offset_tracks[0].offset_parent[static_cast<std::size_t>(t)];
    EXPECT_LT((at.end[standard_joint::ltibia] - plain.end[standard_joint::ltibia] - moved).norm(),
              1e-12);
    EXPECT_LT((at.end[standard_joint::rtibia] - plain.end[standard_joint::rtibia]).norm(), 1e-12);
  }
}

TEST(Trimmed, KeepsTheFramesAskedForAndRefusesOthers) {
  const Motion motion = with_offset_track(swaying_motion(template_skeleton(), 1, 12, 60.0));
  const Motion part = trimmed(motion, 3, 8);
  ASSERT_EQ(part.num_frames(), 5);
  for (int t = 0; t < 5; ++t)
    EXPECT_LT(worst_distance(part.transforms(t), motion.transforms(t + 3)), 1e-12);
  EXPECT_REFUSED(std::invalid_argument, "0 <= begin < end", trimmed(motion, -1, 3));
  EXPECT_REFUSED(std::invalid_argument, "0 <= begin < end", trimmed(motion, 3, 3));
  EXPECT_REFUSED(std::invalid_argument, "0 <= begin < end", trimmed(motion, 3, 13));
}

TEST(Reversed, PlaysBackwardsAndTwiceIsTheMotionItself) {
  const Motion motion = with_offset_track(swaying_motion(template_skeleton(), 2, 9, 60.0));
  const Motion backwards = reversed(motion);
  const Motion again = reversed(backwards);
  for (int t = 0; t < 9; ++t) {
    EXPECT_LT(worst_distance(backwards.transforms(8 - t), motion.transforms(t)), 1e-12);
    EXPECT_LT(worst_distance(again.transforms(t), motion.transforms(t)), 1e-12);
  }
}

TEST(Mirrored, SendsEveryJointToTheOtherSide) {
  const Motion motion = with_offset_track(swaying_motion(lopsided_skeleton(), 3, 20, 60.0));
  const Motion mirror = mirrored(motion, standard_left_right());
  for (int t = 0; t < motion.num_frames(); ++t) {
    const auto original = motion.transforms(t), seen = mirror.transforms(t);
    for (std::size_t j = 0; j < original.end.size(); ++j) {
      const auto other = static_cast<std::size_t>(standard_left_right()[j]);
      EXPECT_LT((seen.end[other] - in_mirror(original.end[j])).norm(), 1e-9);
      EXPECT_LT((seen.pivot[other] - in_mirror(original.pivot[j])).norm(), 1e-9);
      const Mat3 M = Vec3(-1, 1, 1).asDiagonal();
      EXPECT_LT((seen.R_world_joint[other] - M * original.R_world_joint[j] * M).norm(), 1e-9);
    }
  }
}

TEST(Mirrored, TwiceIsTheMotionItself) {
  const Motion motion = with_offset_track(swaying_motion(lopsided_skeleton(), 4, 10, 60.0));
  const Motion twice = mirrored(mirrored(motion, standard_left_right()), standard_left_right());
  for (int t = 0; t < motion.num_frames(); ++t)
    EXPECT_LT(worst_distance(twice.transforms(t), motion.transforms(t)), 1e-9);
  for (int j = 0; j < motion.skeleton.num_joints(); ++j)
    EXPECT_LT((twice.skeleton.joint(j).R_joint_axes - motion.skeleton.joint(j).R_joint_axes).norm(),
              1e-9);
}

TEST(Mirrored, RefusesPartnersThatDoNotMatch) {
  const Motion motion = resting_motion(template_skeleton(), 1, 60.0);
  std::vector<int> partners = standard_left_right();
  EXPECT_REFUSED(std::invalid_argument, "one partner a joint", mirrored(motion, {}));
  partners[standard_joint::rfemur] = standard_joint::rfemur;
  EXPECT_REFUSED(std::invalid_argument, "partners must name each other",
                 mirrored(motion, partners));
  partners = standard_left_right();
  std::swap(partners[standard_joint::lwrist], partners[standard_joint::lfemur]);
  std::swap(partners[standard_joint::rwrist], partners[standard_joint::rfemur]);
  EXPECT_NO_THROW(mirrored(motion, standard_left_right()));
  EXPECT_REFUSED(std::invalid_argument, "the two sides hang on different joints",
                 mirrored(motion, partners));
}

TEST(LeftRightPairs, AreFoundByTheNamesOfManyExporters) {
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"lfemur", "rfemur"},      {"LeftArm", "RightArm"},
      {"hand.L", "hand.R"},      {"mixamorig:LeftLeg", "mixamorig:RightLeg"},
      {"LEFTFOOT", "RIGHTFOOT"}, {"upper_l_arm", "upper_r_arm"},
      {"thigh_L", "thigh_R"},    {"left_wrist", "right_wrist"}};
  for (const auto& [left, right] : pairs) {
    std::vector<Joint> joints(5);
    joints[0].name = "Hips";
    joints[1].name = left;
    joints[2].name = "Spine";
    joints[3].name = right;
    joints[4].name = "Head";
    for (std::size_t j = 1; j < joints.size(); ++j) joints[j].parent = 0;
    EXPECT_EQ(left_right_pairs(Skeleton(joints)), (std::vector<int>{0, 3, 2, 1, 4})) << left;
  }
  EXPECT_EQ(left_right_pairs(template_skeleton()), standard_left_right());
}

// The root sways by sin(2 pi f t) and turns by as many radians.
Motion oscillating(double frequency_hz, double rate_hz, int frames) {
  Motion motion = resting_motion(template_skeleton(), frames, rate_hz, 0.0);
  for (int t = 0; t < frames; ++t) {
    const double s = std::sin(2.0 * kPi * frequency_hz * t / rate_hz);
    motion.root_positions[static_cast<std::size_t>(t)].x() = s;
    motion.rotation(t, 0) = Quat(Eigen::AngleAxisd(s, Vec3::UnitY()));
  }
  return motion;
}

double turn_of(const Quat& q) { return 2.0 * std::atan2(q.y(), q.w()); }

TEST(Resampled, KeepsWhatIsBelowTheBandInPlaceAndTime) {
  const Motion motion = resampled(oscillating(1.0, 120.0, 601), 25.0);
  ASSERT_EQ(motion.num_frames(), 126);
  EXPECT_DOUBLE_EQ(motion.frame_time_s, 0.04);
  for (int t = 3; t < 123; ++t) {
    const double s = std::sin(2.0 * kPi * t / 25.0);
    EXPECT_NEAR(motion.root_positions[static_cast<std::size_t>(t)].x(), s, 0.01);
    EXPECT_NEAR(turn_of(motion.rotation(t, 0)), s, 0.02);
  }
}

TEST(Resampled, AttenuatesWhatWouldAlias) {
  const Motion motion = resampled(oscillating(31.0, 120.0, 601), 25.0);
  for (int t = 3; t < 123; ++t) {
    EXPECT_LT(std::abs(motion.root_positions[static_cast<std::size_t>(t)].x()), 0.06);
    EXPECT_LT(std::abs(turn_of(motion.rotation(t, 0))), 0.06);
  }
}

TEST(Resampled, InterpolatesUpwardsWithoutFiltering) {
  const Motion coarse = oscillating(0.5, 25.0, 51);
  const Motion fine = resampled(coarse, 100.0);
  ASSERT_EQ(fine.num_frames(), 201);
  for (int t = 0; t < 201; ++t) {
    const double s = std::sin(2.0 * kPi * 0.5 * t / 100.0);
    EXPECT_NEAR(fine.root_positions[static_cast<std::size_t>(t)].x(), s, 2.5e-3);
    EXPECT_NEAR(turn_of(fine.rotation(t, 0)), s, 2.5e-3);
  }
}

TEST(Resampled, LeavesTheSameRateAloneAndKeepsOffsetTracks) {
  const Motion motion = with_offset_track(swaying_motion(template_skeleton(), 5, 30, 50.0));
  EXPECT_EQ(resampled(motion, 50.0).num_frames(), 30);
  const Motion half = resampled(motion, 25.0);
  ASSERT_EQ(half.offset_tracks.size(), 1U);
  EXPECT_EQ(half.offset_tracks[0].offset_parent.size(), half.root_positions.size());
  EXPECT_THROW(resampled(motion, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace sparse_mocap
