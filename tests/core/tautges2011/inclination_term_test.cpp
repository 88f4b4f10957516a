// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/inclination_term.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using testing::Random;
using testing::template_skeleton;

// What a sensor of direction reads in a pose of the standard skeleton.
Vec3 up_at(const Skeleton& skeleton, const Eigen::VectorXd& angles, int site) {
  JointTransforms pose;
  forward_kinematics(skeleton, Vec3::Zero(), angles, pose);
  const Site& worn = all_sites()[static_cast<std::size_t>(site)];
  const Mat3 R_world_sensor =
      pose.R_world_joint[static_cast<std::size_t>(worn.orientation)] * worn.R_joint_sensor;
  return R_world_sensor.transpose() * kUp;
}

TEST(InclinationTerm, IsNothingInThePoseThatWasMeasured) {
  Random random(4);
  const Skeleton skeleton = template_skeleton();
  const std::vector<WornSensor> sensors{{find_site("left_wrist"), 1.0, Quantity::up},
                                        {find_site("right_ankle"), 1.0, Quantity::up},
                                        {find_site("right_ankle"), 1.0, Quantity::specific_force},
                                        {find_site("head"), 1.0, Quantity::up}};
  const Eigen::VectorXd weights = Eigen::VectorXd::Constant(3, 1.0 / 3.0);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd angles = random.column(kNumStandardAngles, 0.6);
    Reading reading(3, 4);
    for (Eigen::Index s = 0; s < 4; ++s)
      reading.col(s) = up_at(skeleton, angles, sensors[static_cast<std::size_t>(s)].site);
    const KernelTerm term = inclination_term(skeleton, reading, sensors, 2.0, 3);
    ASSERT_EQ(term.space.joints.size(), 2u);
    const double floor = 2.0 * Energy::kSoftening * Energy::kSoftening;
    EXPECT_NEAR(Energy(skeleton, weights, {term}).value(angles), floor, 1e-9);
    EXPECT_GT(Energy(skeleton, weights, {term}).value(random.column(kNumStandardAngles, 0.6)),
              1e-4);
  }
}

TEST(InclinationTerm, LeavesSilentSensorsOut) {
  const Skeleton skeleton = template_skeleton();
  const std::vector<WornSensor> sensors{{find_site("left_wrist"), 1.0, Quantity::up}};
  const Reading silent = Reading::Constant(3, 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(inclination_term(skeleton, silent, sensors, 2.0, 3).weight, 0.0);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
