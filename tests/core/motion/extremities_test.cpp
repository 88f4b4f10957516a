// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/extremities.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::template_skeleton;

TEST(Extremities, FollowTheStandardJoints) {
  const Skeleton standard = template_skeleton();
  EXPECT_REFUSED(std::invalid_argument, "not a standard skeleton",
                 with_extremities(with_extremities(standard)));
  const Skeleton skeleton = with_extremities(standard);
  EXPECT_TRUE(is_standard(standard));
  EXPECT_FALSE(is_standard(skeleton));
  EXPECT_TRUE(has_extremities(skeleton));
  EXPECT_FALSE(has_extremities(standard));
  ASSERT_EQ(skeleton.num_joints(), 27);
  for (int j = 0; j < 21; ++j) EXPECT_EQ(skeleton.joint(j).name, standard.joint(j).name);
  for (const auto& [name, parent] : {std::pair{"lfoot", "ltibia"},
                                     {"ltoes", "lfoot"},
                                     {"lhand", "lwrist"},
                                     {"rfoot", "rtibia"},
                                     {"rtoes", "rfoot"},
                                     {"rhand", "rwrist"}}) {
    const int joint = skeleton.find(name);
    ASSERT_GE(joint, 21) << name;
    EXPECT_EQ(skeleton.joint(skeleton.joint(joint).parent).name, parent);
  }
  EXPECT_EQ(without_extremities(skeleton).num_joints(), 21);
  EXPECT_EQ(without_extremities(standard).num_joints(), 21);
}

// A leg of one metre has feet of 15 cm and toes of 7.5 cm, about as on HDM05's skeletons.
TEST(Extremities, AreAsLongAsPeoplesByTheirLegs) {
  StandardBones bones = template_bones();
  const double scale = 1.0 / leg_length_m(bones);
  for (auto& bone : bones) bone *= scale;
  const Skeleton skeleton = with_extremities(make_standard_skeleton(bones));
  const auto length = [&](const char* name) {
    return skeleton.joint(skeleton.find(name)).bone.norm();
  };
  EXPECT_NEAR(length("lfoot"), 0.152, 0.003);
  EXPECT_NEAR(length("rtoes"), 0.075, 0.002);
  EXPECT_NEAR(length("lhand"), 0.15, 0.03);
}

TEST(Extremities, HaveAnotherSide) {
  const Skeleton skeleton = with_extremities(template_skeleton());
  const auto& other = left_right_with_extremities();
  ASSERT_EQ(other.size(), 27U);
  for (int j = 0; j < 27; ++j) {
    const int opposite = other[static_cast<std::size_t>(j)];
    EXPECT_EQ(other[static_cast<std::size_t>(opposite)], j);
    if (opposite == j) continue;
    EXPECT_EQ(skeleton.joint(opposite).name.substr(1), skeleton.joint(j).name.substr(1));
    EXPECT_NE(skeleton.joint(opposite).name, skeleton.joint(j).name);
  }
}

TEST(Extremities, RotationVectorsAreThoseOfRodrigues) {
  testing::Random random(4);
  for (int n = 0; n < 200; ++n) {
    const Quat q = random.rotation();
    const Vec3 v = rotation_vector(q);
    EXPECT_LE(v.norm(), kPi + 1e-12);
    Mat3 K;
    K << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    const double angle = v.norm();
    const Mat3 R = Mat3::Identity() + std::sin(angle) / angle * K +
                   (1.0 - std::cos(angle)) / (angle * angle) * K * K;
    EXPECT_LT((R - q.toRotationMatrix()).norm(), 1e-9);
    EXPECT_LT((rotation_of_vector(v).toRotationMatrix() - R).norm(), 1e-9);
  }
  EXPECT_EQ(rotation_vector(Quat::Identity()).norm(), 0.0);
}

// With shanks that hang straight down a relaxed foot is level and points forward.
TEST(Extremities, ARelaxedFootIsLevelBelowAVerticalShank) {
  const Skeleton skeleton = with_extremities(template_skeleton());
  for (const auto foot : {extremity::lfoot, extremity::rfoot}) {
    const Vec3 bone = skeleton.joint(extremity_parent(foot)).bone.normalized();
    const double tilt = std::atan2(bone.x(), -bone.y());  // about z, from straight down
    const Mat3 R_world_shank = Eigen::AngleAxisd(-tilt, Vec3::UnitZ()).toRotationMatrix();
    ASSERT_LT((R_world_shank * bone + Vec3::UnitY()).norm(), 0.02);
    const Mat3 R_world_foot = R_world_shank * relaxed(skeleton, foot);
    EXPECT_LT((R_world_foot * Vec3::UnitY() - Vec3::UnitY()).norm(), 0.02);
    EXPECT_LT((R_world_foot * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 0.02);
  }
  for (const auto hand : {extremity::lhand, extremity::rhand}) {
    const Vec3 bone = skeleton.joint(extremity_joint(hand)).bone;
    EXPECT_LT((relaxed(skeleton, hand) * bone).y(), -0.01);  // palms down, the hand hangs
  }
}

}  // namespace
}  // namespace sparse_mocap
