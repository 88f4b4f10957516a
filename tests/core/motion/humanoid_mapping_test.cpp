// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mapping synthetic bodies: rest poses, names, shapes, refusals, mappings by hand.
#include <gtest/gtest.h>

#include <random>

#include "formats/format_test_support.hpp"
#include "motion/synthetic_body.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/humanoid_errors.hpp"
#include "sparse_mocap/motion/humanoid_file.hpp"

namespace sparse_mocap {
namespace {

using testing::contains;
using testing::error_of;
using testing::TemporaryFolder;
using testing::walk;

Motion mapped(const Motion& motion) {
  const HumanoidMapping mapping = map_humanoid(motion);
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
    map_humanoid(motion, by_hand);
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

TEST(HumanoidMapping, RestPosesOfOneBodyGiveOneMovement) {
  const Motion expected = mapped(walk(testing::t_pose));
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::a_pose))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::i_pose))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::lying))), 2e-3);
  EXPECT_LT(worst_distance_m(expected, mapped(walk(testing::along_x))), 2e-2);
}

TEST(HumanoidMapping, KeepsLimbsPointingWhereTheyDid) {
  for (const auto rest : {testing::t_pose, testing::a_pose, testing::lying, testing::along_x}) {
    const Motion motion = walk(rest);
    const HumanoidMapping mapping = map_humanoid(motion);
    const Motion out = to_standard(motion, mapping, make_standard_skeleton(mapping.bones));
    const auto errors = limb_errors(motion, mapping, out);
    EXPECT_LT(errors.overall_mean_rad(), 0.5 * kRadiansPerDegree);
    EXPECT_LT(errors.overall_worst_rad(), 3.0 * kRadiansPerDegree);
  }
}

TEST(HumanoidMapping, MirroredTwiceIsTheSame) {
  const Motion out = mapped(walk(testing::a_pose));
  const auto& pairs = standard_left_right();
  EXPECT_LT(worst_distance_m(out, mirrored(mirrored(out, pairs), pairs)), 1e-12);
}

TEST(HumanoidMapping, FindsLimbsByShapeWhereNamesDoNotTell) {
  const Motion motion = walk(testing::t_pose);
  const HumanoidMapping named = map_humanoid(motion);
  const HumanoidMapping shaped = map_humanoid(renamed(motion, numbered_names()));
  EXPECT_TRUE(named.source.is_by_names);
  EXPECT_FALSE(shaped.source.is_by_names);
  for (const auto j : {standard_joint::root, standard_joint::lfemur, standard_joint::rtibia,
                       standard_joint::lhumerus, standard_joint::rradius, standard_joint::lwrist})
    EXPECT_EQ(shaped.source.standard[j], named.source.standard[j]) << standard_joint_names()[j];
}

// How other exporters call thigh, shank, upper arm and forearm, and the left hand's side of each.
TEST(HumanoidMapping, KnowsTheNamesOfOtherExporters) {
  const std::vector<std::array<std::string, 4>> exporters{
      {"mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftArm", "mixamorig:LeftForeArm"},
      {"Left_Upper_Leg", "Left_Lower_Leg", "Left_Upper_Arm", "Left_Forearm"},
      {"lThighBend", "lShin", "lShldrBend", "lForearmBend"},
      {"DEF-thigh.L", "DEF-shin.L", "DEF-upper_arm.L", "DEF-forearm.L"},
      {"thigh_l", "calf_l", "upperarm_l", "lowerarm_l"},
      {"J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm"},
      {"Bip01_L_Thigh", "Bip01_L_Calf", "Bip01_L_UpperArm", "Bip01_L_Forearm"},
      {"ValveBiped.Bip01_L_Thigh", "ValveBiped.Bip01_L_Calf", "ValveBiped.Bip01_L_UpperArm",
       "ValveBiped.Bip01_L_Forearm"},
      {"CC_Base_L_Thigh", "CC_Base_L_Calf", "CC_Base_L_Upperarm", "CC_Base_L_Forearm"},
      {"L_Hip", "L_Knee", "L_Shoulder", "L_Elbow"},
      {"HIP_LEFT", "KNEE_LEFT", "SHOULDER_LEFT", "ELBOW_LEFT"},
      {"mHipLeft", "mKneeLeft", "mShoulderLeft", "mElbowLeft"},
      {"LThigh", "LShin", "LUArm", "LFArm"},
      {"c_thigh_fk.l", "c_leg_fk.l", "c_arm_fk.l", "c_forearm_fk.l"},
      {"l_up_leg", "l_low_leg", "l_up_arm", "l_low_arm"},
      {"UpperLeg_L", "LowerLeg_L", "UpperArm_L", "LowerArm_L"}};
  constexpr std::array kParts{BodyPart::thigh, BodyPart::shank, BodyPart::upper_arm,
                              BodyPart::forearm};
  for (const auto& names : exporters) {
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      const auto readings = read_joint_name(names[i]);
      const bool is_known =
          std::any_of(readings.begin(), readings.end(), [&](const NamedPart& reading) {
            return reading.part == kParts[i] && reading.side == Side::left;
          });
      EXPECT_TRUE(is_known) << names[i];
    }
  }
}

TEST(HumanoidMapping, TurnsAFileWithZUp) {
  Motion motion = walk(testing::t_pose);
  const Mat3 R = testing::turn(90.0, Vec3::UnitX());  // y to z
  auto joints = motion.skeleton.joints();
  for (auto& joint : joints) joint.offset_parent = R * joint.offset_parent;
  motion.skeleton = Skeleton(joints);
  for (auto& p : motion.root_positions) p = R * p;
  for (auto& q : motion.rotations) q = Quat(R) * q * Quat(R).conjugate();
  const HumanoidMapping mapping = map_humanoid(motion);
  ASSERT_FALSE(mapping.warnings.empty());
  EXPECT_TRUE(contains(mapping.warnings.back(), "+z, which is taken as up"));
  EXPECT_LT(worst_distance_m(mapped(walk(testing::t_pose)), mapped(motion)), 2e-3);
}

TEST(HumanoidMapping, GuessesMillimetres) {
  Motion motion = walk(testing::t_pose);
  auto joints = motion.skeleton.joints();
  for (auto& joint : joints) joint.offset_parent *= 10.0;
  motion.skeleton = Skeleton(joints);
  for (auto& p : motion.root_positions) p *= 10.0;
  const HumanoidMapping mapping = map_humanoid(motion);
  EXPECT_DOUBLE_EQ(mapping.unit_scale, 0.1);
  EXPECT_TRUE(contains(mapping.warnings.front(), "taken as mm"));
}

TEST(HumanoidMapping, DropsALeadingTPose) {
  Motion motion = walk(testing::t_pose);
  for (int j = 0; j < motion.skeleton.num_joints(); ++j) motion.rotation(0, j) = Quat::Identity();
  const HumanoidMapping mapping = map_humanoid(motion);
  std::vector<std::string> warnings;
  const Motion out = to_standard(motion, mapping, make_standard_skeleton(mapping.bones), &warnings);
  EXPECT_EQ(out.num_frames(), motion.num_frames() - 1);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(contains(warnings[0], "leading rest pose"));
}

TEST(HumanoidMapping, RefusesWhatIsNoBody) {
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
TEST(HumanoidMapping, RefusesAQuadruped) {
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

TEST(HumanoidMapping, TakesAMappingByHand) {
  const Motion motion = renamed(walk(testing::t_pose), numbered_names());
  const JointNames names{{"lfemur", "bone16"}, {"ltibia", "bone17"}, {"lwrist", "bone9"}};
  const HumanoidMapping mapping = map_humanoid(motion, names);
  EXPECT_EQ(mapping.source.standard[standard_joint::lfemur], 16);
  EXPECT_TRUE(contains(refusal_of(motion, {{"lfemor", "bone16"}}), "nearest is 'lfemur'"));
  EXPECT_TRUE(contains(refusal_of(motion, {{"lfemur", "bonee16"}}), "nearest is 'bone16'"));
}

// Bodies with joints pulled together, torn apart or renamed: refused, or mapped to finite motions.
TEST(HumanoidMapping, NeverMakesNonsenseOfOddBodies) {
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
    HumanoidMapping mapping;
    try {
      mapping = map_humanoid(motion);
    } catch (const MappingError&) {
      continue;
    }
    ++num_mapped;
    const Motion out = to_standard(motion, mapping, make_standard_skeleton(template_bones()));
    for (const auto& bone : mapping.bones) EXPECT_TRUE(bone.allFinite()) << trial;
    for (const auto& position : out.root_positions) EXPECT_TRUE(position.allFinite()) << trial;
    for (const auto& rotation : out.rotations) EXPECT_NEAR(rotation.norm(), 1.0, 1e-9) << trial;
  }
  EXPECT_GT(num_mapped, 50);
}

TEST(MappingFile, SurvivesARoundTripAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const Motion motion = walk(testing::t_pose);
  const JointNames names = joint_names(motion.skeleton, map_humanoid(motion));
  EXPECT_EQ(names.at("lfemur"), "LeftUpLeg");
  write_mapping(folder / "mapping.json", names);
  EXPECT_EQ(read_mapping(folder / "mapping.json"), names);
  EXPECT_TRUE(contains(read_file(folder / "mapping.json", 1 << 20), "\"format_version\": 1,\n"));
  const auto unversioned =
      folder.write("old.json", R"({"format": "sparse_mocap_mapping", "joints": {"head": "Head"}})");
  EXPECT_EQ(read_mapping(unversioned), (JointNames{{"head", "Head"}}));
  const auto error = [&](const std::string& text) {
    const auto path = folder.write("bad.json", text);
    return error_of([&] { read_mapping(path); });
  };
  const std::string begin = R"({"format": "sparse_mocap_mapping", )";
  EXPECT_TRUE(contains(error("{"), "is not JSON"));
  EXPECT_TRUE(contains(error("{}"), "is not a mapping"));
  EXPECT_TRUE(contains(error("[]"), "is not a mapping"));
  EXPECT_TRUE(contains(error(begin + R"("joint": {}})"), "unknown key 'joint'"));
  EXPECT_TRUE(contains(error(begin + R"("format_version": 2, "joints": {}})"),
                       "of format version 2, and this program reads version 1; update"));
  EXPECT_TRUE(contains(error(begin + R"("format_version": "1", "joints": {}})"),
                       "of format version \"1\", and this"));
  EXPECT_TRUE(contains(error(begin + R"("joints": {"lfemur": 3}})"), "must be an object"));
  EXPECT_TRUE(contains(error(begin + R"("joints": {"lfemor": "a"}})"), "nearest is 'lfemur'"));
  EXPECT_TRUE(
      contains(error(begin + R"("joints": {"head": "a", "head": "b"}})"), "repeats the key"));
}

}  // namespace
}  // namespace sparse_mocap
