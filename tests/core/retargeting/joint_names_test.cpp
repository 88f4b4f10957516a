// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/joint_names.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace sparse_mocap {
namespace {

TEST(JointNames, AreComparedWithoutNameSpacePrefixSideCaseAndSeparators) {
  Side side = Side::middle;
  EXPECT_EQ(plain_part_name("mixamorig:LeftUpLeg", side), "upleg");
  EXPECT_EQ(side, Side::left);
  EXPECT_EQ(plain_part_name("Upper_Arm.R", side), "upperarm");
  EXPECT_EQ(side, Side::right);
  EXPECT_EQ(plain_part_name("Bip01 L Thigh", side), "thigh");
  EXPECT_EQ(plain_part_name("rfemur", side), "femur");
  EXPECT_EQ(side, Side::right);
  EXPECT_EQ(plain_part_name("::", side), "");
}

// How other exporters call thigh, shank, upper arm and forearm, and the left hand's side of each.
TEST(JointNames, KnowsTheNamesOfOtherExporters) {
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
      const auto parts = parts_named(names[i]);
      const bool is_known = std::any_of(parts.begin(), parts.end(), [&](const NamedPart& named) {
        return named.part == kParts[i] && named.side == Side::left;
      });
      EXPECT_TRUE(is_known) << names[i];
    }
  }
}

}  // namespace
}  // namespace sparse_mocap
