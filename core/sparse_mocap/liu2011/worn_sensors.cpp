// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/worn_sensors.hpp"

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {

std::vector<WornSensor> worn_sensors(const Skeleton& body, const std::vector<Sensor>& sensors) {
  std::vector<WornSensor> worn;
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const Site& site = all_sites()[static_cast<std::size_t>(sensors[s].site)];
    const Vec3 from_end = (sensors[s].position_along_bone - 1.0) * body.joint(site.carrier).bone;
    worn.push_back({static_cast<Eigen::Index>(s), site.carrier, from_end, site.orientation,
                    site.R_joint_sensor, sensors[s].channels});
  }
  return worn;
}

SensorPose sensor_pose(const WornSensor& worn, const JointTransforms& transforms) {
  const auto carrier = static_cast<std::size_t>(worn.carrier);
  const auto turning = static_cast<std::size_t>(worn.turning);
  return {transforms.end[carrier] + transforms.R_world_joint[carrier] * worn.from_end,
          transforms.R_world_joint[turning] * worn.R_joint_sensor};
}

std::vector<Observation> sensors_of(const Skeleton& body, std::span<const WornSensor> worn,
                                    const BodyPose& pose) {
  JointTransforms transforms;
  forward_kinematics(body, pose, transforms);
  std::vector<Observation> sensors;
  for (const WornSensor& one : worn)
    sensors.push_back({one, true, true, sensor_pose(one, transforms)});
  return sensors;
}

std::vector<Observation> observations(const Reading& reading, std::span<const WornSensor> worn,
                                      const HeadingFrame& frame) {
  const Mat3 R_frame_world = yaw_rotation(-frame.yaw_rad);
  std::vector<Observation> found;
  for (const WornSensor& one : worn) {
    Observation observed{one, false, false, {}};
    const Vec3 position = reading.position.col(one.sensor);
    const Eigen::Vector4d orientation = reading.orientation.col(one.sensor);
    if (position.allFinite()) {
      observed.has_position = true;
      observed.measured.position = R_frame_world * (position - frame.origin);
    }
    if (orientation.allFinite() && orientation.norm() > 0.0) {
      observed.has_orientation = true;
      observed.measured.R_frame_sensor =
          R_frame_world * quaternion_of(orientation).normalized().toRotationMatrix();
    }
    if (observed.has_position || observed.has_orientation) found.push_back(observed);
  }
  return found;
}

}  // namespace sparse_mocap::liu2011
