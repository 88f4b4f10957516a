// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recordings of the world; they are not in the repository, see format_test_support.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/acclaim_writer.hpp"
#include "sparse_mocap/formats/bvh.hpp"

namespace sparse_mocap {
namespace {

using testing::real_data;
using testing::TemporaryFolder;

// Reads every motion file below a folder and checks what must hold of any motion.
int read_all(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!is_motion_file(entry.path())) continue;
    MotionFile file;
    EXPECT_NO_THROW(file = read_motion_file(entry.path())) << entry.path();
    const auto& motion = file.motion;
    EXPECT_GT(motion.num_frames(), 0) << entry.path();
    EXPECT_EQ(testing::joined(testing::check_motion(motion)), "") << entry.path();
    ++count;
  }
  return count;
}

double round_trip_error_m(const std::filesystem::path& path,
                          const std::string& written = "out.bvh") {
  const TemporaryFolder folder;
  const auto motion = read_motion_file(path).motion;
  const bool is_bvh = written.ends_with(".bvh");
  (is_bvh ? write_bvh : write_acclaim)(folder / written, motion);
  const auto again = read_motion_file(folder / written).motion;
  EXPECT_EQ(again.num_frames(), motion.num_frames());
  double worst = 0.0;
  for (int frame = 0; frame < motion.num_frames(); frame += 7) {
    const auto expected = motion.transforms(frame);
    const auto actual = again.transforms(frame);
    for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
      const int k = j == 0 ? 0 : again.skeleton.find(motion.skeleton.joint(j).name);
      if (k < 0) return 1e9;
      worst = std::max(worst, (actual.pivot[static_cast<std::size_t>(k)] -
                               expected.pivot[static_cast<std::size_t>(j)])
                                  .norm());
    }
  }
  return worst;
}

TEST(RealFiles, EveryHdm05ClipIsRead) {
  SKIP_WITHOUT_REAL_DATA("hdm05");
  EXPECT_GT(read_all(real_data("hdm05")), 200);
}

TEST(RealFiles, EveryCmuTrialIsRead) {
  SKIP_WITHOUT_REAL_DATA("cmu");
  EXPECT_GT(read_all(real_data("cmu")), 100);
}

TEST(RealFiles, FilesOfManyExportersAreRead) {
  SKIP_WITHOUT_REAL_DATA("bvh_exporters");
  EXPECT_GT(read_all(real_data("bvh_exporters")), 60);
}

TEST(RealFiles, AnotherAcclaimExporterIsRead) {
  SKIP_WITHOUT_REAL_DATA("acclaim_variants");
  EXPECT_EQ(read_all(real_data("acclaim_variants")), 1);
}

// The CMU trials exist in both formats: a T-pose and then the same rotations. The conversion adds
// dummy joints without length and shortens the thorax and wrists, so the joints below are compared.
TEST(RealFiles, CmuAmcAndBvhAgree) {
  SKIP_WITHOUT_REAL_DATA("cmu/asf_amc/02_01.amc");
  SKIP_WITHOUT_REAL_DATA("cmu/bvh/02_01.bvh");
  const std::map<std::string, std::string> same_pivot{
      {"root", "Hips"},           {"lfemur", "LeftUpLeg"},  {"ltibia", "LeftLeg"},
      {"lfoot", "LeftFoot"},      {"ltoes", "LeftToeBase"}, {"rfemur", "RightUpLeg"},
      {"rtibia", "RightLeg"},     {"rfoot", "RightFoot"},   {"rtoes", "RightToeBase"},
      {"lowerback", "LowerBack"}, {"upperback", "Spine"},   {"thorax", "Spine1"}};
  for (const std::string trial : {"02_01", "02_02", "02_05"}) {
    const auto amc = read_motion_file(real_data("cmu/asf_amc/" + trial + ".amc")).motion;
    const auto bvh =
        read_bvh(real_data("cmu/bvh/" + trial + ".bvh"), {.unit_m = 0.0254 / 0.45}).motion;
    ASSERT_EQ(bvh.num_frames(), amc.num_frames() + 1) << "a leading T-pose";
    double worst = 0.0;
    for (int frame = 0; frame < amc.num_frames(); frame += 5) {
      const auto from = amc.transforms(frame);
      const auto to = bvh.transforms(frame + 1);
      for (const auto& [bone, joint] : same_pivot) {
        const auto a = static_cast<std::size_t>(amc.skeleton.find(bone));
        const auto b = static_cast<std::size_t>(bvh.skeleton.find(joint));
        worst = std::max(worst, (from.pivot[a] - to.pivot[b]).norm());
      }
    }
    EXPECT_LT(worst, 2e-4) << trial << " (the BVH has four decimals)";
  }
}

TEST(RealFiles, RoundTripsThroughBvh) {
  SKIP_WITHOUT_REAL_DATA("hdm05/HDM_bd.asf");
  SKIP_WITHOUT_REAL_DATA("cmu/bvh/02_01.bvh");
  SKIP_WITHOUT_REAL_DATA("bvh_exporters/makehuman/benchmark.bvh");
  EXPECT_LT(round_trip_error_m(real_data("hdm05/HDM_bd_lieDownFloor_001_120.amc")), 1e-6);
  EXPECT_LT(round_trip_error_m(real_data("cmu/asf_amc/02_01.amc")), 1e-6);
  EXPECT_LT(round_trip_error_m(real_data("cmu/bvh/02_01.bvh")), 1e-6);
  EXPECT_LT(round_trip_error_m(real_data("bvh_exporters/makehuman/benchmark.bvh")), 1e-6)
      << "163 joints that move";
}

// Skeletons of Acclaim files come back as they were, and so do the rows but for whole turns.
void expect_same_acclaim(const std::filesystem::path& path) {
  const TemporaryFolder folder;
  const auto motion = read_motion_file(path).motion;
  write_acclaim(folder / "out.amc", motion);
  const auto again = read_motion_file(folder / "out.amc").motion;
  ASSERT_EQ(again.skeleton.num_joints(), motion.skeleton.num_joints());
  for (int j = 0; j < motion.skeleton.num_joints(); ++j) {
    const auto& a = again.skeleton.joint(j);
    const auto& b = motion.skeleton.joint(j);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.axes, b.axes) << a.name;
    EXPECT_LT((a.bone - b.bone).norm(), 1e-10) << a.name;
    EXPECT_LT((a.R_joint_axes - b.R_joint_axes).norm(), 1e-10) << a.name;
  }
  double turn = 0.0;
  double distance_m = 0.0;
  for (std::size_t i = 0; i < motion.rotations.size(); ++i)
    turn = std::max(turn, again.rotations[i].angularDistance(motion.rotations[i]));
  for (std::size_t i = 0; i < motion.root_positions.size(); ++i)
    distance_m = std::max(distance_m, (again.root_positions[i] - motion.root_positions[i]).norm());
  EXPECT_LT(turn, 1e-7) << path;
  EXPECT_LT(distance_m, 1e-7) << path;
}

TEST(RealFiles, RoundTripsThroughAcclaim) {
  SKIP_WITHOUT_REAL_DATA("hdm05/HDM_bd.asf");
  SKIP_WITHOUT_REAL_DATA("cmu/bvh/02_01.bvh");
  SKIP_WITHOUT_REAL_DATA("bvh_exporters/makehuman/benchmark.bvh");
  SKIP_WITHOUT_REAL_DATA("acclaim_variants");
  for (const std::string name :
       {"hdm05/HDM_bd_lieDownFloor_001_120.amc",
        "hdm05/HDM_mm_rotateArmsBothBackward1Reps_001_120.amc", "cmu/asf_amc/02_01.amc",
        "cmu/asf_amc/01_01.amc", "acclaim_variants/walking.amc"}) {
    if (real_data(name).empty()) continue;
    EXPECT_LT(round_trip_error_m(real_data(name), "out.amc"), 1e-6) << name;
    expect_same_acclaim(real_data(name));
  }
  EXPECT_LT(round_trip_error_m(real_data("cmu/bvh/02_01.bvh"), "out.amc"), 1e-6);
  EXPECT_LT(round_trip_error_m(real_data("bvh_exporters/makehuman/benchmark.bvh"), "out.amc"), 1e-6)
      << "163 joints that move";
}

}  // namespace
}  // namespace sparse_mocap
