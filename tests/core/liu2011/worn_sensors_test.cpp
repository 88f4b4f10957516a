// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/worn_sensors.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::pose_of;
using testing::swaying_motion;
using testing::template_skeleton;

std::vector<Sensor> everywhere(double position_along_bone) {
  std::vector<Sensor> sensors;
  for (int site = 0; site < static_cast<int>(all_sites().size()); ++site)
    sensors.push_back({site, position_along_bone, Channel::position | Channel::orientation});
  return sensors;
}

TEST(WornSensors, AreWhereVirtualSensorsAre) {
  const Motion motion = swaying_motion(template_skeleton(), 3, 20, 50.0);
  const auto truth = virtual_readings(motion, all_sites());
  for (const double along : {0.0, 0.4, 1.0}) {
    const auto worn = worn_sensors(motion.skeleton, everywhere(along));
    for (int t = 0; t < motion.num_frames(); ++t) {
      const auto seen = sensors_of(motion.skeleton, worn, pose_of(motion, t));
      for (std::size_t s = 0; s < worn.size(); ++s) {
        const SensorPose& modelled = seen[s].measured;
        EXPECT_LT((modelled.position - truth[s].position(along).col(t)).norm(), 1e-9);
        EXPECT_LT(
            (modelled.R_frame_sensor - truth[s].R_world_sensor[static_cast<std::size_t>(t)]).norm(),
            1e-9);
      }
    }
  }
}

TEST(Observations, AreWhatIsMeasuredInTheFrame) {
  const auto sensors = everywhere(1.0);
  const auto worn = worn_sensors(template_skeleton(), sensors);
  Reading reading(static_cast<Eigen::Index>(sensors.size()));
  EXPECT_TRUE(observations(reading, worn, {}).empty());
  testing::Random random(1);
  const Quat turn = random.rotation();
  reading.position.col(2) = Vec3(1.0, 2.0, 3.0);
  reading.orientation.col(2) = wxyz_of(turn);
  reading.orientation.col(5) = 2.0 * wxyz_of(turn);  // of any length
  reading.position.col(7) = Vec3(1.0, std::numeric_limits<double>::quiet_NaN(), 3.0);
  const HeadingFrame frame{0.7, {0.5, 0.0, -0.5}};
  const auto found = observations(reading, worn, frame);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].worn.sensor, 2);
  EXPECT_TRUE(found[0].has_position && found[0].has_orientation);
  EXPECT_LT(
      (yaw_rotation(0.7) * found[0].measured.position + frame.origin - Vec3(1.0, 2.0, 3.0)).norm(),
      1e-12);
  EXPECT_EQ(found[1].worn.sensor, 5);
  EXPECT_FALSE(found[1].has_position);
  EXPECT_LT((yaw_rotation(0.7) * found[1].measured.R_frame_sensor - turn.toRotationMatrix()).norm(),
            1e-12);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
