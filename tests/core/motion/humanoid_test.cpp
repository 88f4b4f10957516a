// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/humanoid_names.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::contains;
using testing::real_data;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

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
    map_humanoid(skeleton);
  } catch (const MappingError& error) {
    return error.what();
  }
  return "";
}

TEST(HumanoidNames, AreComparedWithoutNameSpacePrefixSideCaseAndSeparators) {
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

TEST(MapHumanoid, FindsTheStandardSkeletonInItself) {
  const HumanoidMapping mapping = map_humanoid(template_skeleton());
  for (int j = 0; j < kNumStandardJoints; ++j) {
    const auto at = static_cast<std::size_t>(j);
    EXPECT_LT((mapping.bones[at] - template_bones()[at]).norm(), 1e-12);
    if (j == lhipjoint || j == rhipjoint) continue;  // they follow the root
    EXPECT_EQ(mapping.source.standard[at], j);
    ASSERT_EQ(mapping.carriers[at].size(), 1U);
    EXPECT_EQ(mapping.carriers[at][0].R_joint_standard, Mat3::Identity());
  }
  EXPECT_EQ(mapping.unit_scale, 1.0);
  EXPECT_TRUE(mapping.warnings.empty());
}

TEST(MapHumanoid, SaysWhichJointsAreMissing) {
  EXPECT_EQ(mapping_error(template_without({"lfemur", "rradius"})),
            "not recognised as a human body: no joint found for left thigh, right forearm "
            "among the 19 joints");
  EXPECT_TRUE(contains(mapping_error(Skeleton()), "no joint found for left thigh"));
}

TEST(MapHumanoid, AcceptsABodyWithoutTheOptionalJoints) {
  const auto mapping = map_humanoid(template_without(
      {"lhipjoint", "rhipjoint", "upperback", "lclavicle", "rclavicle", "upperneck", "lwrist"}));
  EXPECT_EQ(mapping.source.standard[upperback], -1);
  for (std::size_t j = 1; j < kNumStandardJoints; ++j) EXPECT_GT(mapping.bones[j].norm(), 1e-3);
  const Vec3 spine = mapping.bones[lowerback] + mapping.bones[upperback] + mapping.bones[thorax];
  EXPECT_GT(spine.y(), 0.2);
}

TEST(MapHumanoid, GuessesTheUnitFromTheLegsAndSaysSo) {
  // What a file in m, mm, inches or 1/0.45 inches looks like when read as one in cm.
  for (const double scale : {0.01, 10.0, 1.0 / 2.54, 0.45 / 2.54}) {
    const auto mapping = map_humanoid(template_without({}, scale));
    EXPECT_GT(leg_length_m(mapping.bones), 0.45);
    EXPECT_LT(leg_length_m(mapping.bones), 1.25);
    ASSERT_EQ(mapping.warnings.size(), 1U);
    EXPECT_TRUE(contains(mapping.warnings[0], "unit"));
  }
  EXPECT_TRUE(contains(mapping_error(template_without({}, 1e-9)), "not a human body's"));
}

TEST(MapHumanoid, TellsATPoseFromAnAPose) {
  std::vector<Joint> joints = template_skeleton().joints();
  const Mat3 lowered = Eigen::AngleAxisd(-0.8, Vec3::UnitZ()).toRotationMatrix();
  for (const auto j : {lhumerus, lradius, lwrist}) joints[j].bone = lowered * joints[j].bone;
  const auto mapping = map_humanoid(Skeleton(joints));
  for (const auto j : {lhumerus, lradius, lwrist}) {
    EXPECT_LT((mapping.carriers[j].front().R_joint_standard * template_bones()[j] - joints[j].bone)
                  .norm(),
              1e-9);
    EXPECT_LT((mapping.bones[j] - template_bones()[j]).norm(), 1e-9);
  }
  const Vec3& other = template_bones()[rhumerus];
  EXPECT_LT((mapping.carriers[rhumerus].front().R_joint_standard * other - other).norm(), 1e-9);
}

double worst_position_error_m(const Motion& a, const Motion& b) {
  return (joint_positions(a, PositionFrame::world) - joint_positions(b, PositionFrame::world))
      .cwiseAbs()
      .maxCoeff();
}

TEST(ToStandard, KeepsAMotionThatIsOnTheStandardAlready) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 25, 60.0);
  const Motion again = to_standard(motion, map_humanoid(motion.skeleton), motion.skeleton);
  EXPECT_LT(worst_position_error_m(again, motion), 1e-9);
}

TEST(ToStandard, SurvivesABvhFile) {
  const TemporaryFolder folder;
  const Motion motion = swaying_motion(template_skeleton(), 2, 25, 60.0);
  write_bvh(folder / "motion.bvh", motion);
  const Motion read = read_bvh(folder / "motion.bvh").motion;
  const Motion again = to_standard(read, map_humanoid(read.skeleton), motion.skeleton);
  EXPECT_LT(worst_position_error_m(again, motion), 1e-5);
}

TEST(ToStandard, ScalesTheRootsWayWithTheLegs) {
  const Motion motion = swaying_motion(template_skeleton(), 3, 25, 60.0);
  StandardBones small = template_bones();
  for (auto& bone : small) bone *= 0.8;
  const Motion on_small =
      to_standard(motion, map_humanoid(motion.skeleton), make_standard_skeleton(small));
  for (std::size_t t = 0; t < 25; ++t)
    EXPECT_LT((on_small.root_positions[t] - 0.8 * motion.root_positions[t]).norm(), 1e-9);
}

// How many frames are left, and whether it is said.
void expect_dropped(const Motion& motion, int dropped) {
  std::vector<std::string> warnings;
  const Motion standard =
      to_standard(motion, map_humanoid(motion.skeleton), motion.skeleton, &warnings);
  EXPECT_EQ(standard.num_frames(), motion.num_frames() - dropped);
  ASSERT_EQ(warnings.size(), dropped > 0 ? 1U : 0U);
  if (dropped > 0) {
    EXPECT_TRUE(contains(warnings[0], "rest pose"));
  }
}

TEST(ToStandard, DropsALeadingRestPoseAndSaysSo) {
  Motion motion = swaying_motion(template_skeleton(), 4, 25, 60.0);
  expect_dropped(motion, 0);
  for (int j = 0; j < kNumStandardJoints; ++j) motion.rotation(0, j).setIdentity();
  expect_dropped(motion, 1);
}

TEST(ToStandard, DropsALeadingTPoseThatIsNotTheRestPose) {
  Motion motion = swaying_motion(template_skeleton(), 4, 25, 60.0);
  for (const int frames : {1, 2}) {  // the arms fall between a T-pose and the first frame
    for (int t = 0; t < frames; ++t) {
      for (int j = 0; j < kNumStandardJoints; ++j) motion.rotation(t, j).setIdentity();
      motion.rotation(t, lfemur) = Quat(Eigen::AngleAxisd(-0.36, Vec3::UnitZ()));
      motion.rotation(t, lhumerus) = Quat(Eigen::AngleAxisd(1.4, Vec3::UnitZ()));
    }
    expect_dropped(motion, frames);
  }
}

TEST(ToStandard, KeepsTheFirstFrameOfAQuickMovement) {
  Motion motion = swaying_motion(template_skeleton(), 4, 25, 25.0);
  for (int t = 0; t < 25; ++t)  // 25 rad/s, already under way
    motion.rotation(t, lhumerus) = Quat(Eigen::AngleAxisd(1.0 * t, Vec3::UnitZ()));
  expect_dropped(motion, 0);
}

TEST(StandardAngles, GiveTheMotionBackAndDoNotJump) {
  const Motion motion = swaying_motion(template_skeleton(), 5, 100, 60.0);
  const Eigen::MatrixXd angles = standard_angles(motion);
  JointTransforms pose;
  for (int t = 0; t < motion.num_frames(); ++t) {
    forward_kinematics(motion.skeleton, motion.root_positions[static_cast<std::size_t>(t)],
                       angles.col(t), pose);
    const auto expected = motion.transforms(t);
    for (std::size_t j = 0; j < pose.end.size(); ++j)
      EXPECT_LT((pose.end[j] - expected.end[j]).norm(), 1e-9);
    if (t > 0) {
      EXPECT_LT((angles.col(t) - angles.col(t - 1)).cwiseAbs().maxCoeff(), 0.2);
    }
  }
}

// One trial, from both formats, on one skeleton: distances of the joints in cm.
Eigen::MatrixXd cmu_differences_cm(const std::string& trial, const Skeleton& skeleton) {
  const auto amc = read_motion_file(real_data("cmu/asf_amc/" + trial + ".amc")).motion;
  const auto bvh = read_motion_file(real_data("cmu/bvh/" + trial + ".bvh")).motion;
  const auto from_amc = joint_positions(to_standard(amc, map_humanoid(amc.skeleton), skeleton),
                                        PositionFrame::heading);
  const auto from_bvh = joint_positions(to_standard(bvh, map_humanoid(bvh.skeleton), skeleton),
                                        PositionFrame::heading);
  EXPECT_EQ(from_amc.cols(), from_bvh.cols()) << trial;
  const auto frames = std::min(from_amc.cols(), from_bvh.cols());
  Eigen::MatrixXd distances(kNumStandardJoints, frames);
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      distances(j, t) =
          100.0 * (from_amc.block<3, 1>(3 * j, t) - from_bvh.block<3, 1>(3 * j, t)).norm();
  return distances;
}

TEST(ToStandard, BringsTheAmcAndTheBvhOfACmuTrialTogether) {
  SKIP_WITHOUT_REAL_DATA("cmu/asf_amc/02.asf");
  SKIP_WITHOUT_REAL_DATA("cmu/bvh/02_01.bvh");
  const Skeleton skeleton = make_standard_skeleton(
      map_humanoid(read_motion_file(real_data("cmu/asf_amc/02_01.amc")).motion.skeleton).bones);
  double sum = 0.0, worst = 0.0;
  Eigen::Index count = 0;
  for (const std::string trial : {"02_01", "02_02", "02_05", "02_06", "02_07", "02_10"}) {
    const Eigen::MatrixXd distances = cmu_differences_cm(trial, skeleton);
    sum += distances.sum();
    count += distances.size();
    worst = std::max(worst, distances.maxCoeff());
    EXPECT_LT(distances.mean(), 0.1) << trial;
  }
  std::cout << "CMU, AMC against BVH: mean " << sum / static_cast<double>(count) << " cm, worst "
            << worst << " cm\n";
}

}  // namespace
}  // namespace sparse_mocap
