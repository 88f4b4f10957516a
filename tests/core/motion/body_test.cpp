// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/body.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::contains;

std::string complaint(const Body& body) {
  try {
    check_body(body);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Body, RefusesBonesThatNobodyHas) {
  const Body good{"anna", template_bones()};
  EXPECT_EQ(complaint(good), "");
  Body body = good;
  body.bones[head].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(contains(complaint(body), "the bone 'head' must be at most 1 m long"));
  body = good;
  body.bones[lfemur].x() = 1.01;
  EXPECT_TRUE(contains(complaint(body), "the bone 'lfemur' must be at most 1 m long"));
  body = good;
  body.bones[rradius].setZero();
  EXPECT_EQ(complaint(body), "the bone 'rradius' has no length");
  body = good;
  for (auto& bone : body.bones) bone *= 0.25;
  EXPECT_TRUE(contains(complaint(body), "must be between 0.5 and 2.5 m, got 0.4"));
}

TEST(Body, HasTheHeightThatWasAskedFor) {
  for (const double height : {0.5, 1.2, 1.75, 2.5}) {
    const Body body = body_of_height(height);
    EXPECT_NEAR(standing_height_m(body.bones), height, 1e-12);
    EXPECT_EQ(complaint(body), "");
    const double scale = body.bones[lfemur].norm() / template_bones()[lfemur].norm();
    for (std::size_t j = 0; j < body.bones.size(); ++j)
      EXPECT_LT((body.bones[j] - scale * template_bones()[j]).norm(), 1e-12) << j;
  }
  for (const double height : {175.0, 0.0, -1.8, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(body_of_height(height), ConfigError) << height;
}

// Forward kinematics of the body with its legs turned upright measures what the formula adds up.
TEST(Body, StandsAsTallAsItsJointsAreWithUprightLegs) {
  const StandardBones& bones = template_bones();
  Motion motion;
  motion.skeleton = make_standard_skeleton(bones);
  motion.frame_time_s = 1.0;
  motion.root_positions = {Vec3::Zero()};
  motion.rotations.assign(kNumStandardJoints, Quat::Identity());
  for (const auto joint : {lfemur, rfemur})
    motion.rotation(0, joint) = Quat::FromTwoVectors(bones[static_cast<std::size_t>(joint)], -kUp);
  for (const auto& [joint, thigh] : {std::pair{ltibia, lfemur}, {rtibia, rfemur}})
    motion.rotation(0, joint) = motion.rotation(0, thigh).conjugate() *
                                Quat::FromTwoVectors(bones[static_cast<std::size_t>(joint)], -kUp);
  const auto pose = motion.transforms(0);
  const double rise = pose.end[head].y() - 0.5 * (pose.end[ltibia].y() + pose.end[rtibia].y());
  EXPECT_NEAR(rise, 0.961 * standing_height_m(bones), 1e-9);
  EXPECT_NEAR(standing_height_m(bones), 1.70, 0.05);
}

}  // namespace
}  // namespace sparse_mocap
