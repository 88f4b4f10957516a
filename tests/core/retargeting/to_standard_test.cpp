// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/to_standard.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;
using testing::contains;
using testing::real_data;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

double worst_position_error_m(const Motion& a, const Motion& b) {
  return (joint_positions(a, PositionFrame::world) - joint_positions(b, PositionFrame::world))
      .cwiseAbs()
      .maxCoeff();
}

TEST(ToStandard, KeepsAMotionThatIsOnTheStandardAlready) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 25, 60.0);
  const Motion again = to_standard(motion, map_skeleton(motion.skeleton), motion.skeleton);
  EXPECT_LT(worst_position_error_m(again, motion), 1e-9);
}

TEST(ToStandard, SurvivesABvhFile) {
  const TemporaryFolder folder;
  const Motion motion = swaying_motion(template_skeleton(), 2, 25, 60.0);
  write_bvh(folder / "motion.bvh", motion);
  const Motion read = read_bvh(folder / "motion.bvh").motion;
  const Motion again = to_standard(read, map_skeleton(read.skeleton), motion.skeleton);
  EXPECT_LT(worst_position_error_m(again, motion), 1e-5);
}

TEST(ToStandard, ScalesTheRootsWayWithTheLegs) {
  const Motion motion = swaying_motion(template_skeleton(), 3, 25, 60.0);
  StandardBones small = template_bones();
  for (auto& bone : small) bone *= 0.8;
  const Motion on_small =
      to_standard(motion, map_skeleton(motion.skeleton), make_standard_skeleton(small));
  for (std::size_t t = 0; t < 25; ++t)
    EXPECT_LT((on_small.root_positions[t] - 0.8 * motion.root_positions[t]).norm(), 1e-9);
}

// A squat; from frame to frame the knees bend by up to 8 degrees.
Motion squatting_motion(int frames) {
  const Skeleton skeleton = template_skeleton();
  Motion motion = testing::resting_motion(skeleton, frames, 60.0);
  for (int t = 0; t < frames; ++t) {
    const double depth = std::sin(kPi * (t + 1.0) / (frames + 1.0));
    const double knee = 150.0 * kRadiansPerDegree * depth;
    for (const auto& [thigh, shank] : {std::pair{lfemur, ltibia}, std::pair{rfemur, rtibia}}) {
      motion.rotation(t, thigh) = Quat(Eigen::AngleAxisd(-0.5 * knee, Vec3::UnitX()));
      motion.rotation(t, shank) = Quat(joint_rotation(skeleton.joint(shank), &knee));
    }
  }
  return motion;
}

TEST(ToStandard, MendsThighsThatAFileTurnsAboutThemselvesWhereKneesAreBentFar) {
  const Motion truth = squatting_motion(60);
  Motion file = truth;
  for (int t = 20; t < 40; ++t) {
    const Vec3 along = truth.skeleton.joint(lfemur).bone.normalized();
    file.rotation(t, lfemur) = truth.rotation(t, lfemur) * Quat(Eigen::AngleAxisd(kPi, along));
    file.rotation(t, ltibia) = truth.rotation(t, ltibia).conjugate();
  }
  ASSERT_LT(worst_position_error_m(file, truth), 1e-3);  // hinges are not quite across the bones
  const Motion mended = to_standard(file, map_skeleton(file.skeleton), truth.skeleton);
  EXPECT_LT(worst_position_error_m(mended, truth), 2e-3);
  for (int t = 0; t < truth.num_frames(); ++t)
    for (const auto joint : {lfemur, ltibia})
      EXPECT_LT(mended.rotation(t, joint).angularDistance(truth.rotation(t, joint)), 0.01) << t;
}

// How many frames are left, and whether it is said.
void expect_dropped(const Motion& motion, int dropped) {
  std::vector<std::string> warnings;
  const Motion standard =
      to_standard(motion, map_skeleton(motion.skeleton), motion.skeleton, &warnings);
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

// One trial, from both formats, on one skeleton: distances of the joints in cm.
Eigen::MatrixXd cmu_differences_cm(const std::string& trial, const Skeleton& skeleton) {
  const auto amc = read_motion_file(real_data("cmu/asf_amc/" + trial + ".amc")).motion;
  const auto bvh = read_motion_file(real_data("cmu/bvh/" + trial + ".bvh")).motion;
  const auto from_amc = joint_positions(to_standard(amc, map_skeleton(amc.skeleton), skeleton),
                                        PositionFrame::heading);
  const auto from_bvh = joint_positions(to_standard(bvh, map_skeleton(bvh.skeleton), skeleton),
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
      map_skeleton(read_motion_file(real_data("cmu/asf_amc/02_01.amc")).motion.skeleton).bones);
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
