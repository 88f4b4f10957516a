// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/skeleton_mapping.hpp"

#include <gtest/gtest.h>

#include <random>

#include "formats/format_test_support.hpp"
#include "retargeting/synthetic_body.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/retargeting/limb_errors.hpp"
#include "sparse_mocap/retargeting/mapping_error.hpp"
#include "sparse_mocap/retargeting/to_rig.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::contains;
using testing::template_skeleton;
using testing::walk;

Motion mapped(const Motion& motion) {
  const SkeletonMapping mapping = map_skeleton(motion);
  return to_standard(motion, mapping, make_standard_skeleton(mapping.bones));
}

double worst_distance_m(const Motion& a, const Motion& b) {
  const Eigen::MatrixXd p = joint_positions(a, PositionFrame::world);
  const Eigen::MatrixXd q = joint_positions(b, PositionFrame::world);
  EXPECT_EQ(p.cols(), q.cols());
  return p.cols() == q.cols() ? (p - q).cwiseAbs().maxCoeff() : 1e9;
}

std::string refusal_of(const Motion& motion, const JointNames& by_hand = {}) {
  try {
    map_skeleton(motion, by_hand);
  } catch (const MappingError& error) {
    return error.what();
  }
  return "";
}

Motion renamed(Motion motion, const std::vector<std::string>& names) {
  auto joints = motion.skeleton.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j].name = names[j];
  motion.skeleton = Skeleton(joints);
  return motion;
}

std::vector<std::string> numbered_names() {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < testing::person().size(); ++j)
    names.push_back("bone" + std::to_string(j));
  return names;
}

// The template body with other bones, or without some joints; what follows them moves up.
Skeleton template_without(const std::vector<std::string>& left_out, double scale = 1.0) {
  const Skeleton full = template_skeleton();
  std::vector<Joint> joints;
  std::vector<int> index(static_cast<std::size_t>(full.num_joints()), -1);
  for (int j = 0; j < full.num_joints(); ++j) {
    Joint joint = full.joint(j);
    joint.bone *= scale;
    if (std::count(left_out.begin(), left_out.end(), joint.name) > 0) {
      index[static_cast<std::size_t>(j)] = index[static_cast<std::size_t>(joint.parent)];
      continue;
    }
    if (joint.parent >= 0) joint.parent = index[static_cast<std::size_t>(joint.parent)];
    index[static_cast<std::size_t>(j)] = static_cast<int>(joints.size());
    joints.push_back(joint);
  }
  return Skeleton(joints);
}

std::string mapping_error(const Skeleton& skeleton) {
  try {
    map_skeleton(skeleton);
  } catch (const MappingError& error) {
    return error.what();
  }
  return "";
}

TEST(MapSkeleton, FindsTheStandardSkeletonInItself) {
  const SkeletonMapping mapping = map_skeleton(template_skeleton());
  for (int j = 0; j < kNumStandardJoints; ++j) {
    const auto at = static_cast<std::size_t>(j);
    EXPECT_LT((mapping.bones[at] - template_bones()[at]).norm(), 1e-12);
    if (j == lhipjoint || j == rhipjoint) continue;  // they follow the root
    EXPECT_EQ(mapping.joints.standard[at], j);
    ASSERT_EQ(mapping.joint_mapping[at].size(), 1U);
    EXPECT_EQ(mapping.joint_mapping[at][0].R_joint_standard, Mat3::Identity());
  }
  EXPECT_EQ(mapping.unit_scale, 1.0);
  EXPECT_TRUE(mapping.warnings.empty());
}

TEST(MapSkeleton, SaysWhichJointsAreMissing) {
  EXPECT_EQ(mapping_error(template_without({"lfemur", "rradius"})),
            "not recognised as a human body: no joint found for left thigh, right forearm "
            "among the 19 joints");
  EXPECT_TRUE(contains(mapping_error(Skeleton()), "no joint found for left thigh"));
}

TEST(MapSkeleton, AcceptsABodyWithoutTheOptionalJoints) {
  const auto mapping = map_skeleton(template_without(
      {"lhipjoint", "rhipjoint", "upperback", "lclavicle", "rclavicle", "upperneck", "lwrist"}));
  EXPECT_EQ(mapping.joints.standard[upperback], -1);
  for (std::size_t j = 1; j < kNumStandardJoints; ++j) EXPECT_GT(mapping.bones[j].norm(), 1e-3);
  const Vec3 spine = mapping.bones[lowerback] + mapping.bones[upperback] + mapping.bones[thorax];
  EXPECT_GT(spine.y(), 0.2);
}

TEST(MapSkeleton, GuessesTheUnitFromTheLegsAndSaysSo) {
  // What a file in m, mm, inches or 1/0.45 inches looks like when read as one in cm.
  for (const double scale : {0.01, 10.0, 1.0 / 2.54, 0.45 / 2.54}) {
    const auto mapping = map_skeleton(template_without({}, scale));
    EXPECT_GT(leg_length_m(mapping.bones), 0.45);
    EXPECT_LT(leg_length_m(mapping.bones), 1.25);
    ASSERT_EQ(mapping.warnings.size(), 1U);
    EXPECT_TRUE(contains(mapping.warnings[0], "unit"));
  }
}

TEST(MapSkeleton, ScalesAFigureOfNoUsualUnitToUsualLegs) {
  for (const double scale : {1e-3, 3e-4, 40.0}) {
    const auto mapping = map_skeleton(template_without({}, scale));
    EXPECT_NEAR(leg_length_m(mapping.bones), 0.85, 0.4) << scale;
    ASSERT_EQ(mapping.warnings.size(), 1U);
  }
  const auto mapping = map_skeleton(template_without({}, 1e-9));
  EXPECT_NEAR(leg_length_m(mapping.bones), 0.85, 1e-3);
  EXPECT_TRUE(contains(mapping.warnings[0], "scaled to legs of"));
}

TEST(MapSkeleton, TellsATPoseFromAnAPose) {
  std::vector<Joint> joints = template_skeleton().joints();
  const Mat3 lowered = Eigen::AngleAxisd(-0.8, Vec3::UnitZ()).toRotationMatrix();
  for (const auto j : {lhumerus, lradius, lwrist}) joints[j].bone = lowered * joints[j].bone;
  const auto mapping = map_skeleton(Skeleton(joints));
  for (const auto j : {lhumerus, lradius, lwrist}) {
    EXPECT_LT(
        (mapping.joint_mapping[j].front().R_joint_standard * template_bones()[j] - joints[j].bone)
            .norm(),
        1e-9);
    EXPECT_LT((mapping.bones[j] - template_bones()[j]).norm(), 1e-9);
  }
  const Vec3& other = template_bones()[rhumerus];
  EXPECT_LT((mapping.joint_mapping[rhumerus].front().R_joint_standard * other - other).norm(),
            1e-9);
}

// --- Synthetic people
// ------------------------------------------------------------------------------

TEST(MapSkeleton, RestPosesOfOneBodyGiveOneMovement) {
  const Motion expected = mapped(walk(testing::t_pose));
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::a_pose))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::i_pose))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::lying))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::along_x))), 2e-2);
}

TEST(MapSkeleton, KeepsLimbsPointingWhereTheyDid) {
  for (const auto rest : {testing::t_pose, testing::a_pose, testing::lying, testing::along_x}) {
    const Motion motion = walk(rest);
    const SkeletonMapping mapping = map_skeleton(motion);
    const Motion out = to_standard(motion, mapping, make_standard_skeleton(mapping.bones));
    const auto errors = limb_errors(motion, mapping, out);
    EXPECT_LT(errors.overall_mean_rad(), 0.5 * kRadiansPerDegree);
    EXPECT_LT(errors.overall_worst_rad(), 3.0 * kRadiansPerDegree);
  }
}

TEST(MapSkeleton, MirroredTwiceIsTheSame) {
  const Motion out = mapped(walk(testing::a_pose));
  const auto& pairs = standard_left_right();
  EXPECT_LT(worst_distance_m(out, mirrored(mirrored(out, pairs), pairs)), 1e-12);
}

TEST(MapSkeleton, FindsLimbsByShapeWhereNamesDoNotTell) {
  const Motion motion = walk(testing::t_pose);
  const SkeletonMapping named = map_skeleton(motion);
  const SkeletonMapping shaped = map_skeleton(renamed(motion, numbered_names()));
  EXPECT_TRUE(named.joints.is_by_names);
  EXPECT_FALSE(shaped.joints.is_by_names);
  for (const auto j : {standard_joint::root, standard_joint::lfemur, standard_joint::rtibia,
                       standard_joint::lhumerus, standard_joint::rradius, standard_joint::lwrist})
    EXPECT_EQ(shaped.joints.standard[j], named.joints.standard[j]) << standard_joint_names()[j];
}

TEST(MapSkeleton, TurnsAFileWithZUp) {
  Motion motion = walk(testing::t_pose);
  const Mat3 R = testing::turn(90.0, Vec3::UnitX());  // y to z
  auto joints = motion.skeleton.joints();
  for (auto& joint : joints) joint.offset_parent = R * joint.offset_parent;
  motion.skeleton = Skeleton(joints);
  for (auto& p : motion.root_positions) p = R * p;
  for (auto& q : motion.rotations) q = Quat(R) * q * Quat(R).conjugate();
  const SkeletonMapping mapping = map_skeleton(motion);
  ASSERT_FALSE(mapping.warnings.empty());
  EXPECT_TRUE(contains(mapping.warnings.back(), "+z, which is taken as up"));
  EXPECT_LT(worst_distance_m(mapped(walk(testing::t_pose)), mapped(motion)), 2e-3);
}

TEST(MapSkeleton, GuessesMillimetres) {
  Motion motion = walk(testing::t_pose);
  auto joints = motion.skeleton.joints();
  for (auto& joint : joints) joint.offset_parent *= 10.0;
  motion.skeleton = Skeleton(joints);
  for (auto& p : motion.root_positions) p *= 10.0;
  const SkeletonMapping mapping = map_skeleton(motion);
  EXPECT_DOUBLE_EQ(mapping.unit_scale, 0.1);
  EXPECT_TRUE(contains(mapping.warnings.front(), "taken as mm"));
}

TEST(MapSkeleton, DropsALeadingTPose) {
  Motion motion = walk(testing::t_pose);
  for (int j = 0; j < motion.skeleton.num_joints(); ++j) motion.rotation(0, j) = Quat::Identity();
  const SkeletonMapping mapping = map_skeleton(motion);
  std::vector<std::string> warnings;
  const Motion out = to_standard(motion, mapping, make_standard_skeleton(mapping.bones), &warnings);
  EXPECT_EQ(out.num_frames(), motion.num_frames() - 1);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(contains(warnings[0], "leading rest pose"));
}

TEST(MapSkeleton, RefusesWhatIsNoBody) {
  auto half = testing::person();
  half.resize(6);
  EXPECT_TRUE(contains(refusal_of(walk(testing::t_pose, half)), "no joint found for left thigh"));
  auto no_arms = testing::person();
  no_arms.resize(6);
  const auto whole = testing::person();
  for (std::size_t j = 16; j < whole.size(); ++j) {
    no_arms.push_back(whole[j]);
    if (no_arms.back().parent >= 16) no_arms.back().parent -= 10;
  }
  EXPECT_EQ(refusal_of(walk(testing::t_pose, no_arms)),
            "not recognised as a human body: no joint found for left upper arm, right upper arm, "
            "left forearm, right forearm among the 14 joints");
}

// A dog with a person's names: the trunk is level, all four limbs go down.
TEST(MapSkeleton, RefusesAQuadruped) {
  auto dog = testing::person();
  for (auto& part : dog) {
    const Vec3 p = part.position;
    const std::string name = part.name;
    const bool is_limb = contains(name, "Arm") || contains(name, "Hand") || contains(name, "Fing");
    if (is_limb) {
      part.position = {p.x() > 0 ? 0.15 : -0.15, 0.9 - (std::abs(p.x()) - 0.2), 0.55};
    } else if (p.y() > 0.95) {
      part.position = {p.x(), 0.95, p.y() - 0.95};
    }
  }
  Motion still = walk(testing::t_pose, dog);
  for (auto& q : still.rotations) q = Quat::Identity();
  EXPECT_TRUE(contains(refusal_of(still), "as an animal's do")) << refusal_of(still);
}

TEST(MapSkeleton, TakesAMappingByHand) {
  const Motion motion = renamed(walk(testing::t_pose), numbered_names());
  const JointNames names{{"lfemur", "bone16"}, {"ltibia", "bone17"}, {"lwrist", "bone9"}};
  const SkeletonMapping mapping = map_skeleton(motion, names);
  EXPECT_EQ(mapping.joints.standard[standard_joint::lfemur], 16);
  EXPECT_TRUE(contains(refusal_of(motion, {{"lfemor", "bone16"}}), "nearest is 'lfemur'"));
  EXPECT_TRUE(contains(refusal_of(motion, {{"lfemur", "bonee16"}}), "nearest is 'bone16'"));
}

// Bodies with joints pulled together, torn apart or renamed: refused, or mapped to finite motions.
TEST(MapSkeleton, NeverMakesNonsenseOfOddBodies) {
  std::mt19937 random(7);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  int num_mapped = 0;
  for (int trial = 0; trial < 400; ++trial) {
    auto body = testing::person();
    const int size = static_cast<int>(body.size());
    for (int change = pick(6); change >= 0; --change) {
      auto& part = body[static_cast<std::size_t>(1 + pick(size - 1))];
      const auto& parent = body[static_cast<std::size_t>(part.parent)];
      const int kind = pick(3);
      if (kind == 0) part.position = parent.position;
      if (kind == 1) part.position += 0.3 * Vec3::Random();
      if (kind == 2) part.name = body[static_cast<std::size_t>(pick(size))].name;
    }
    Motion motion;
    try {
      motion = trimmed(walk(trial % 2 == 0 ? testing::t_pose : testing::along_x, body), 0, 5);
    } catch (const std::invalid_argument&) {
      continue;  // two joints of one name are no skeleton
    }
    SkeletonMapping mapping;
    try {
      mapping = map_skeleton(motion);
    } catch (const MappingError&) {
      continue;
    }
    ++num_mapped;
    const Motion out = to_standard(motion, mapping, make_standard_skeleton(template_bones()));
    const Motion back = to_rig(out, mapping, motion.skeleton);
    for (const auto& bone : mapping.bones) EXPECT_TRUE(bone.allFinite()) << trial;
    for (const auto& made : {out, back}) {
      for (const auto& position : made.root_positions) EXPECT_TRUE(position.allFinite()) << trial;
      for (const auto& rotation : made.rotations) EXPECT_NEAR(rotation.norm(), 1.0, 1e-9) << trial;
    }
  }
  EXPECT_GT(num_mapped, 50);
}

}  // namespace
}  // namespace sparse_mocap
