// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recordings of the world; they are not in the repository, see format_test_support.hpp.
#include <gtest/gtest.h>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/motion_file.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/retargeting/limb_errors.hpp"
#include "sparse_mocap/retargeting/mapping_error.hpp"
#include "sparse_mocap/retargeting/source_motion.hpp"
#include "sparse_mocap/retargeting/to_rig.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::real_data;

Motion read_some(const fs::path& path) {
  Motion motion = read_motion_file(path).motion;
  return motion.num_frames() > 400 ? trimmed(motion, 0, 400) : motion;
}

Motion mapped(const Motion& motion, const SkeletonMapping& mapping) {
  return to_standard(motion, mapping, make_standard_skeleton(mapping.bones));
}

// Limb directions of each file of an exporter; files that are no people must be listed.
TEST(RetargetedRealFiles, EveryExporterKeepsItsLimbDirections) {
  SKIP_WITHOUT_REAL_DATA("bvh_exporters");
  const std::vector<std::string> no_people{"full_precision_frame_time.bvh",
                                           "rotation_first_root.bvh"};
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(real_data("bvh_exporters"))) {
    if (!is_motion_file(entry.path())) continue;
    const Motion motion = read_some(entry.path());
    const std::string name = entry.path().filename().string();
    if (std::find(no_people.begin(), no_people.end(), name) != no_people.end()) {
      EXPECT_THROW(map_skeleton(motion), MappingError) << entry.path();
      continue;
    }
    SkeletonMapping mapping;
    ASSERT_NO_THROW(mapping = map_skeleton(motion)) << entry.path();
    const auto errors = limb_errors(motion, mapping, mapped(motion, mapping));
    EXPECT_LT(errors.overall_mean_rad(), 1.5 * kRadiansPerDegree) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

// Mean angle (rad) between the long limbs of a motion and of another on the same rig.
double mean_limb_angle_rad(const Motion& a, const Motion& b, const BodyJoints& joints) {
  double sum = 0.0;
  for (int t = 0; t < b.num_frames(); ++t) {
    const int lead = a.num_frames() - b.num_frames();
    const auto p = bone_positions(a.skeleton, joints, a.transforms(t + lead));
    const auto q = bone_positions(b.skeleton, joints, b.transforms(t));
    for (const auto limb : kLimbBones) sum += angle_between(p.vector(limb), q.vector(limb));
  }
  return sum / static_cast<double>(kLimbBones.size() * static_cast<std::size_t>(b.num_frames()));
}

TEST(RetargetedRealFiles, LimbsPointWhereTheyDidAfterTheWayToTheStandardAndBack) {
  SKIP_WITHOUT_REAL_DATA("bvh_exporters");
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(real_data("bvh_exporters"))) {
    if (!is_motion_file(entry.path())) continue;
    const Motion motion = read_some(entry.path());
    SkeletonMapping mapping;
    try {
      mapping = map_skeleton(motion);
    } catch (const MappingError&) {
      continue;  // the test above lists these
    }
    const Motion back = to_rig(mapped(motion, mapping), mapping, motion.skeleton);
    const double angle_rad =
        mean_limb_angle_rad(without_collapsed_offsets(motion), back, mapping.joints);
    EXPECT_LT(angle_rad, 1.5 * kRadiansPerDegree) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

// Whether a knee is bent past its stop, the thigh turned half round instead.
bool has_turned_thigh(const Motion& motion, int frame) {
  for (const char* name : {"ltibia", "rtibia"}) {
    const int j = motion.skeleton.find(name);
    double angle = 0.0;
    joint_angles(motion.skeleton.joint(j), motion.rotation(frame, j).toRotationMatrix(), nullptr,
                 &angle);
    if (angle < -0.5 * kPi) return true;
  }
  return false;
}

// The standard skeleton is HDM05's own: each of its joints must stay where it was; nearly so where
// a thigh is turned back, for hinges are not quite across the bones.
TEST(RetargetedRealFiles, Hdm05IsCarriedOverExactly) {
  SKIP_WITHOUT_REAL_DATA("hdm05");
  int count = 0;
  for (const auto& entry : fs::directory_iterator(real_data("hdm05"))) {
    if (!is_motion_file(entry.path()) || ++count % 12 != 0) continue;
    const Motion motion = read_some(entry.path());
    const SkeletonMapping mapping = map_skeleton(motion);
    const Motion out = mapped(motion, mapping);
    ASSERT_EQ(out.num_frames(), motion.num_frames());
    for (int t = 0; t < motion.num_frames(); t += 10) {
      const double tolerance_m = has_turned_thigh(motion, t) ? 3e-3 : 1e-9;
      const auto expected = motion.transforms(t), actual = out.transforms(t);
      for (int j = 0; j < kNumStandardJoints; ++j) {
        const auto at = static_cast<std::size_t>(j);
        const int s = motion.skeleton.find(standard_joint_names()[at]);
        ASSERT_GE(s, 0);
        EXPECT_LT((actual.end[at] - expected.end[static_cast<std::size_t>(s)]).norm(), tolerance_m)
            << entry.path() << " " << standard_joint_names()[at];
      }
    }
  }
  EXPECT_GT(count, 0);
}

TEST(RetargetedRealFiles, CmuAgreesInBothFormats) {
  SKIP_WITHOUT_REAL_DATA("cmu/bvh/02_01.bvh");
  for (const std::string name : {"02_01", "02_02", "02_05"}) {
    const Motion amc = read_motion_file(real_data("cmu/asf_amc/" + name + ".amc")).motion;
    const Motion bvh = read_motion_file(real_data("cmu/bvh/" + name + ".bvh")).motion;
    const SkeletonMapping mapping = map_skeleton(amc);
    const Skeleton standard = make_standard_skeleton(mapping.bones);
    const Eigen::MatrixXd p =
        joint_positions(to_standard(amc, mapping, standard), PositionFrame::heading);
    const Eigen::MatrixXd q =
        joint_positions(to_standard(bvh, map_skeleton(bvh), standard), PositionFrame::heading);
    ASSERT_EQ(p.cols(), q.cols()) << name;
    const Eigen::MatrixXd difference = p - q;
    double mean_m = 0.0;
    for (Eigen::Index t = 0; t < p.cols(); ++t)
      for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
        mean_m += difference.block<3, 1>(3 * j, t).norm();
    EXPECT_LT(mean_m / static_cast<double>(p.cols() * kNumStandardJoints), 1e-3) << name;
  }
}

}  // namespace
}  // namespace sparse_mocap
