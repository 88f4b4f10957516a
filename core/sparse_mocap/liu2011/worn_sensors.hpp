// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "sparse_mocap/liu2011/body_pose.hpp"
#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap::liu2011 {

// A sensor on a body: z of Liu et al. 2011, section 6.1, its local coordinates p_j and o_j.
struct WornSensor {
  Eigen::Index sensor = 0;       // column of the reading
  int carrier = 0;               // joint that it sits on
  Vec3 from_end = Vec3::Zero();  // m, from the carrier's end, in the carrier's frame
  int turning = 0;               // joint whose rotation it follows
  Mat3 R_joint_sensor = Mat3::Identity();
  Channels channels;  // of which position and orientation say where it is
};

std::vector<WornSensor> worn_sensors(const Skeleton& body, const std::vector<Sensor>& sensors);

// Where a sensor is: f(q; s, z), the forward kinematics of section 6.1.
struct SensorPose {
  Vec3 position = Vec3::Zero();  // m
  Mat3 R_frame_sensor = Mat3::Identity();
};
SensorPose sensor_pose(const WornSensor& worn, const JointTransforms& transforms);

// What a sensor says of where it is: c_t of one sensor, in a heading frame.
struct Observation {
  WornSensor worn;
  bool has_position = false, has_orientation = false;
  SensorPose measured;
  double position_looseness = 1.0;  // deviations of its position, in sigma_data
};

// What sensors would say of where they are on a body in a pose.
std::vector<Observation> sensors_of(const Skeleton& body, std::span<const WornSensor> worn,
                                    const BodyPose& pose);

// The sensors of a reading that say where they are, in the world turned and moved into the frame.
std::vector<Observation> observations(const Reading& reading, std::span<const WornSensor> worn,
                                      const HeadingFrame& frame);

}  // namespace sparse_mocap::liu2011
