// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/sensor_motion.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::Random;
using testing::random_pose;
using testing::template_skeleton;

TEST(AddMovedPositions, MovesOnAsAccelerationsSay) {
  const Skeleton body = template_skeleton();
  Random random(1);
  const auto worn =
      worn_sensors(body, {{find_site("left_wrist"), 1.0, Channel::orientation},
                          {find_site("pelvis"), 1.0, Channel::orientation | Channel::position}});
  const std::vector<BodyPose> recent{random_pose(body, random, 0.2),
                                     random_pose(body, random, 0.2)};
  auto observed = sensors_of(body, worn, random_pose(body, random, 0.2));
  observed[0].has_position = false;
  const Vec3 measured = observed[1].measured.position;
  Eigen::Matrix3Xd accelerations = Eigen::Matrix3Xd::Zero(3, 2);
  accelerations.col(0) << 1.0, 2.0, 3.0;
  add_moved_positions(body, recent, accelerations, 0.1, 5.0, observed);
  const Vec3 newest = sensors_of(body, worn, recent[0])[0].measured.position;
  const Vec3 before = sensors_of(body, worn, recent[1])[0].measured.position;
  EXPECT_TRUE(observed[0].has_position);
  EXPECT_EQ(observed[0].position_looseness, 5.0);
  EXPECT_LT((observed[0].measured.position - (newest + (newest - before) + Vec3(0.01, 0.02, 0.03)))
                .norm(),
            1e-12);
  EXPECT_EQ(observed[1].measured.position, measured);
  EXPECT_EQ(observed[1].position_looseness, 1.0);
}

TEST(LinearAccelerations, AreZeroAtRest) {
  Reading reading(2);
  reading.orientation.col(0) << 0.5, 0.5, 0.5, 0.5;
  reading.specific_force.col(0) = Quat(0.5, 0.5, 0.5, 0.5).conjugate() * (kGravity_mps2 * kUp);
  reading.specific_force.col(1) << 1.0, 2.0, 3.0;
  const auto found = linear_accelerations(reading);
  EXPECT_LT(found.col(0).norm(), 1e-12);
  EXPECT_FALSE(found.col(1).allFinite());
}

}  // namespace
}  // namespace sparse_mocap::liu2011
