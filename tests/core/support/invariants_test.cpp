// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each check is one that can fail.
#include "support/invariants.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

Motion good_motion() {
  Motion motion = swaying_motion(template_skeleton(), 1, 5, 25.0);
  motion.offset_tracks.push_back({3, std::vector<Vec3>(5, Vec3(0.1, 0.2, 0.3))});
  return motion;
}

template <typename Change>
std::string motion_with(const Change& change) {
  Motion motion = good_motion();
  change(motion);
  return joined(check_motion(motion));
}

template <typename Change>
std::string joint_with(const Change& change) {
  auto joints = good_motion().skeleton.joints();
  change(joints[4]);
  return joined(check_skeleton(Skeleton(std::move(joints))));
}

TEST(Invariants, HoldOfGoodThings) {
  EXPECT_EQ(joined(check_motion(good_motion())), "");
  EXPECT_EQ(joined(check_database(*database_of({good_motion()}))), "");
}

TEST(Invariants, SeeWhatIsWrongWithASkeleton) {
  EXPECT_NE(joint_with([](Joint& joint) { joint.name = "H\xFC"; }), "");
  EXPECT_NE(joint_with([](Joint& joint) { joint.name = "\xED\xA0\x80"; }), "");
  EXPECT_NE(joint_with([](Joint& joint) { joint.bone.x() = 1e9; }), "");
  EXPECT_NE(joint_with([](Joint& joint) { joint.R_joint_axes *= 1.001; }), "");
  EXPECT_NE(joint_with([](Joint& joint) { joint.R_joint_axes.col(0) *= -1.0; }), "");
  EXPECT_NE(joint_with([](Joint& joint) { joint.axes = {Axis::x, Axis::x}; }), "");
  EXPECT_EQ(joint_with([](Joint& joint) { joint.name = "H\xC3\xBC"; }), "");
  EXPECT_NE(joined(check_skeleton(Skeleton())), "");
}

TEST(Invariants, SeeWhatIsWrongWithAMotion) {
  EXPECT_NE(motion_with([](Motion& m) { m.frame_time_s = 0.0; }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.frame_time_s = std::nan(""); }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.rotations.pop_back(); }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.rotation(2, 3).w() += 1e-6; }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.rotation(2, 3).x() = std::nan(""); }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.root_positions[1].y() = std::nan(""); }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.offset_tracks[0].joint = 0; }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.offset_tracks[0].offset_parent.pop_back(); }), "");
  EXPECT_NE(motion_with([](Motion& m) { m.offset_tracks.push_back(m.offset_tracks[0]); }), "");
}

}  // namespace
}  // namespace sparse_mocap::testing
