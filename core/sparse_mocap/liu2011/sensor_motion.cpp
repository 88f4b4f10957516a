// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/sensor_motion.hpp"

#include "sparse_mocap/base/quaternions.hpp"

namespace sparse_mocap::liu2011 {

Eigen::Matrix3Xd linear_accelerations(const Reading& reading) {
  Eigen::Matrix3Xd out = reading.specific_force;
  for (Eigen::Index s = 0; s < out.cols(); ++s) {
    const Eigen::Vector4d orientation = reading.orientation.col(s);
    out.col(s) = quaternion_of(orientation).normalized() * Vec3(out.col(s)) - kGravity_mps2 * kUp;
  }
  return out;
}

void add_moved_positions(const Skeleton& body, std::span<const BodyPose> recent,
                         const Eigen::Matrix3Xd& accelerations, double frame_time_s,
                         double looseness, std::vector<Observation>& observed) {
  JointTransforms newest, before;
  forward_kinematics(body, recent[0], newest);
  forward_kinematics(body, recent[1], before);
  for (Observation& one : observed) {
    const Vec3 acceleration = accelerations.col(one.worn.sensor);
    if (one.has_position || !acceleration.allFinite()) continue;
    one.has_position = true;
    one.position_looseness = looseness;
    one.measured.position = 2.0 * sensor_pose(one.worn, newest).position -
                            sensor_pose(one.worn, before).position +
                            acceleration * frame_time_s * frame_time_s;
  }
}

}  // namespace sparse_mocap::liu2011
