// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_calibration.hpp"

#include <gtest/gtest.h>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/liu2011/calibration_poses.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::Random;
using namespace standard_joint;

std::vector<Sensor> six() {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso"})
    sensors.push_back({find_site(site)});
  return sensors;
}

Mat3 small_turn(Random& random, double size_rad) {
  const Vec3 turn = random.vector(size_rad);
  return turn.norm() > 0.0 ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                           : Mat3::Identity();
}

// A performer with trackers that are turned and shifted on their limbs.
struct Performer {
  StandardBones bones{};
  std::vector<Mat3> R_site_sensor;
  std::vector<Vec3> offset_m;
  double yaw_rad = 2.3;

  explicit Performer(Random& random) {
    const BoneLengthModel model = published_bone_lengths();
    const Eigen::VectorXd own = random.column(model.modes.cols(), 1.0);
    bones = bones_of_lengths(model.mean_m + model.modes * own);
    for (std::size_t j = 0; j < six().size(); ++j) {
      R_site_sensor.push_back(small_turn(random, 1.0));
      offset_m.push_back(random.vector(0.04));
    }
  }

  HeldPose hold(int index, Random& random, double missed_rad) const {
    const Skeleton skeleton = make_standard_skeleton(bones);
    JointRotations rotations = calibration_poses()[static_cast<std::size_t>(index)].rotations;
    for (auto& R : rotations) R = R * small_turn(random, missed_rad);
    rotations = reachable(skeleton, rotations);
    rotations[root] = yaw_rotation(yaw_rad) * rotations[root];
    JointTransforms at;
    forward_kinematics(skeleton, random.vector(1.0), rotations, at);
    HeldPose held{index, {}};
    for (std::size_t j = 0; j < six().size(); ++j) {
      const Site& site = all_sites()[static_cast<std::size_t>(six()[j].site)];
      const Mat3 R_world_site = at.R_world_joint[site.orientation] * site.R_joint_sensor;
      held.sensors.push_back({true, true, at.end[site.carrier] + R_world_site * offset_m[j],
                              R_world_site * R_site_sensor[j]});
    }
    return held;
  }

  std::vector<HeldPose> hold_all(Random& random, double missed_rad) const {
    std::vector<HeldPose> held;
    for (int i = 0; i < static_cast<int>(calibration_poses().size()); ++i)
      held.push_back(hold(i, random, missed_rad));
    return held;
  }

  double mounting_error_deg(const PoseCalibration& found, std::size_t j) const {
    const Mat3 off = found.sensors[j].R_site_sensor * R_site_sensor[j].transpose();
    return Eigen::AngleAxisd(off).angle() / kRadiansPerDegree;
  }
};

TEST(CalibratedFromPoses, RefusesWhatCannotBe) {
  Random random(1);
  const Performer performer(random);
  const BoneLengthModel lengths = published_bone_lengths();
  auto held = performer.hold_all(random, 0.0);
  EXPECT_THROW(calibrated_from_poses(lengths, {}, held, {}), ConfigError);
  EXPECT_THROW(calibrated_from_poses(lengths, six(), {}, {}), ConfigError);
  for (auto& sensor : held[2].sensors) sensor.has_position = sensor.has_orientation = false;
  EXPECT_THROW(calibrated_from_poses(lengths, six(), held, {}), ConfigError);
  held[2].sensors.pop_back();
  EXPECT_THROW(calibrated_from_poses(lengths, six(), held, {}), ConfigError);
}

TEST(CalibratedFromPoses, FindsBonesAndSensorsFromExactPoses) {
  Random random(2);
  for (int trial = 0; trial < 3; ++trial) {
    const Performer performer(random);
    const auto found =
        calibrated_from_poses(published_bone_lengths(), six(), performer.hold_all(random, 0.0), {});
    const BoneLengths error = lengths_of(found.bones) - lengths_of(performer.bones);
    int num_determined = 0;
    for (Eigen::Index b = 0; b < kNumBoneLengths; ++b)
      if (found.is_determined[static_cast<std::size_t>(b)]) {
        ++num_determined;
        EXPECT_LT(std::abs(error[b]), 0.02)
            << standard_joint_names()[static_cast<std::size_t>(b) + 1];
      }
    EXPECT_GE(num_determined, 7);  // upper arms, thighs, trunk
    EXPECT_TRUE(found.is_determined[lfemur - 1] && found.is_determined[rhumerus - 1]);
    for (std::size_t j = 0; j < six().size(); ++j) {
      EXPECT_LT(performer.mounting_error_deg(found, j), 3.0);
      EXPECT_TRUE(found.sensors[j].is_mounting_determined);
      EXPECT_LT((found.sensors[j].offset_m - performer.offset_m[j]).norm(), 0.05);
    }
    EXPECT_NEAR(std::remainder(found.yaw_rad - performer.yaw_rad, 2.0 * kPi), 0.0, 0.05);
    EXPECT_FALSE(found.are_poses_alike);
  }
}

TEST(CalibratedFromPoses, SaysHowFarThePerformerMissesThePoses) {
  Random random(3);
  const Performer performer(random);
  const auto exact =
      calibrated_from_poses(published_bone_lengths(), six(), performer.hold_all(random, 0.0), {});
  const auto rough = calibrated_from_poses(published_bone_lengths(), six(),
                                           performer.hold_all(random, 6.0 * kRadiansPerDegree), {});
  EXPECT_LT(exact.imitation_deg, 2.5);
  EXPECT_GT(rough.imitation_deg, 1.5 * exact.imitation_deg);
  ASSERT_EQ(rough.missed_deg.size(), calibration_poses().size());
  for (std::size_t i = 0; i < rough.missed_deg.size(); ++i)
    EXPECT_GT(rough.missed_deg[i], exact.missed_deg[i]);
  for (std::size_t j = 0; j < six().size(); ++j)
    EXPECT_GT(rough.sensors[j].mounting_deviation_deg, exact.sensors[j].mounting_deviation_deg);
}

TEST(CalibratedFromPoses, SaysThatPosesAreAlike) {
  Random random(4);
  const Performer performer(random);
  std::vector<HeldPose> held;
  for (int i = 0; i < 8; ++i) held.push_back(performer.hold(0, random, 0.03));
  const auto found = calibrated_from_poses(published_bone_lengths(), six(), held, {});
  EXPECT_TRUE(found.are_poses_alike);
  EXPECT_FALSE(found.is_determined[lfemur - 1]);
  EXPECT_FALSE(found.sensors[0].is_offset_determined);
}

TEST(CalibratedFromPoses, TakesOrientationsAlone) {
  Random random(5);
  const Performer performer(random);
  auto held = performer.hold_all(random, 0.0);
  for (auto& pose : held)
    for (auto& sensor : pose.sensors) sensor.has_position = false;
  const auto found = calibrated_from_poses(published_bone_lengths(), six(), held, {});
  for (std::size_t j = 0; j < six().size(); ++j)
    EXPECT_LT(performer.mounting_error_deg(found, j), 3.0);
  for (const bool is_determined : found.is_determined) EXPECT_FALSE(is_determined);
  EXPECT_LT((lengths_of(found.bones) - published_bone_lengths().mean_m).norm(), 1e-6);
}

// Where a bone points in a pose, in the body's frame.
Vec3 direction(std::string_view pose, Index joint) {
  JointTransforms at;
  forward_kinematics(
      make_standard_skeleton(template_bones()), Vec3::Zero(),
      calibration_poses()[static_cast<std::size_t>(find_calibration_pose(pose))].rotations, at);
  return (at.end[joint] - at.pivot[joint]).normalized();
}

TEST(CalibrationPoses, PointLimbsWhereTheInstructionSays) {
  const Vec3 left = Vec3::UnitX(), up = Vec3::UnitY(), forward = Vec3::UnitZ();
  EXPECT_EQ(calibration_poses().size(), 8U);
  for (const auto& pose : calibration_poses())
    EXPECT_GT(direction(pose.name, lfemur).dot(pose.name == "left_knee_up" ? forward : -up), 0.999)
        << pose.name;
  EXPECT_GT(direction("arms_out", lradius).dot(left), 0.999);
  EXPECT_GT(direction("arms_forward", rradius).dot(forward), 0.999);
  EXPECT_GT(direction("arms_up", lradius).dot(up), 0.999);
  EXPECT_GT(direction("elbows_bent", lhumerus).dot(-up), 0.999);
  EXPECT_GT(direction("elbows_bent", lradius).dot(forward), 0.999);
  EXPECT_GT(direction("elbows_bent", rradius).dot(forward), 0.999);
  EXPECT_GT(direction("bow", thorax).dot(up + forward), 0.99 * std::sqrt(2.0));
  EXPECT_GT(direction("left_knee_up", lfemur).dot(forward), 0.999);
  EXPECT_GT(direction("left_knee_up", ltibia).dot(-up), 0.999);
  EXPECT_GT(direction("left_knee_up", rtibia).dot(-up), 0.999);
  EXPECT_GT(direction("right_knee_up", rtibia).dot(-up), 0.999);
  EXPECT_GT(direction("right_knee_up", lradius).dot(forward), 0.999);
  EXPECT_GT(direction("lean_left", head).dot(left), 0.4);
  EXPECT_THROW(find_calibration_pose("handstand"), ConfigError);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
