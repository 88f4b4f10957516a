// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/extremity_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/retargeting/skeleton_mapping.hpp"
#include "sparse_mocap/retargeting/to_rig.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::swaying_motion;
using testing::template_skeleton;

// A body that moves feet, toes and hands as well.
Motion moving_body(const Skeleton& skeleton) { return swaying_motion(skeleton, 3, 30, 25.0); }

double angle_rad(const Quat& a, const Quat& b) { return a.angularDistance(b); }

TEST(ExtremityMapping, FindsFeetToesAndHandsByName) {
  const Skeleton rig = with_extremities(template_skeleton());
  const SkeletonMapping mapping = map_skeleton(rig);
  for (int e = 0; e < kNumExtremities; ++e)
    EXPECT_EQ(mapping.extremities[static_cast<std::size_t>(e)].joint, extremity_joint(e));
}

TEST(ExtremityMapping, ABodyWithoutThemHasNone) {
  const SkeletonMapping mapping = map_skeleton(template_skeleton());
  EXPECT_EQ(mapping.extremities[extremity::lfoot].joint, -1);
  EXPECT_EQ(mapping.extremities[extremity::rtoes].joint, -1);
}

// On a skeleton of the same kind every rotation is carried over as it is, there and back.
TEST(ExtremityMapping, CarriesRotationsThereAndBack) {
  const Skeleton rig = with_extremities(template_skeleton());
  const Motion source = moving_body(rig);
  const SkeletonMapping mapping = map_skeleton(source);
  const Motion standard = to_standard(source, mapping, rig);
  const Motion back = to_rig(standard, mapping, rig);
  for (int t = 0; t < source.num_frames(); ++t) {
    for (int e = 0; e < kNumExtremities; ++e) {
      const int joint = extremity_joint(e);
      EXPECT_LT(angle_rad(standard.rotation(t, joint), source.rotation(t, joint)), 1e-6);
      EXPECT_LT(angle_rad(back.rotation(t, joint), source.rotation(t, joint)), 1e-6);
    }
  }
}

// Feet that point outward in the rest pose do so on the standard skeleton too.
TEST(ExtremityMapping, FeetPointWhereTheRigsDo) {
  std::vector<Joint> joints = with_extremities(template_skeleton()).joints();
  const Eigen::AngleAxisd outward(20.0 * kRadiansPerDegree, kUp);
  for (const char* name : {"lfoot", "ltoes"})
    for (auto& joint : joints)
      if (joint.name == name) joint.bone = outward * joint.bone;
  const Skeleton rig(joints);
  const Motion source = moving_body(rig);
  const SkeletonMapping mapping = map_skeleton(source);
  const Skeleton full = with_extremities(template_skeleton());
  const Motion standard = to_standard(source, mapping, full);
  const int foot = full.find("lfoot");
  for (int t = 0; t < source.num_frames(); ++t) {
    const auto there = standard.transforms(t), here = source.transforms(t);
    const auto j = static_cast<std::size_t>(foot);
    const Vec3 a = there.end[j] - there.pivot[j], b = here.end[j] - here.pivot[j];
    EXPECT_LT(std::acos(std::min(1.0, a.normalized().dot(b.normalized()))), 1e-3);
  }
}

// A rig without them keeps its rest where the motion has none.
TEST(ExtremityMapping, FeetKeepTheirRestWhereTheMotionHasNone) {
  const Skeleton rig = with_extremities(template_skeleton());
  const SkeletonMapping mapping = map_skeleton(rig);
  const Motion moved = to_rig(swaying_motion(template_skeleton(), 2, 5, 25.0), mapping, rig);
  for (int e = 0; e < kNumExtremities; ++e)
    EXPECT_LT(angle_rad(moved.rotation(3, extremity_joint(e)), Quat::Identity()), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap
