// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/sensor_sample.hpp"

#include "sparse_mocap/base/quaternions.hpp"

namespace sparse_mocap {

bool SensorSample::has_any(Channels channels) const {
  const bool has_force = specific_force.allFinite(), has_turn = angular_velocity.allFinite();
  return (channels.has(Channel::specific_force) && has_force) ||
         (channels.has(Channel::angular_velocity) && has_turn) ||
         (channels.has(Channel::gravity_direction) && has_force && has_turn) ||
         (channels.has(Channel::position) && position.allFinite()) ||
         (channels.has(Channel::orientation) && orientation.allFinite());
}

SensorSample SensorCorrection::operator()(const SensorSample& sample) const {
  SensorSample out = sample;
  out.specific_force = R_site_sensor * (scale * sample.specific_force);
  out.angular_velocity = R_site_sensor * (sample.angular_velocity - gyroscope_bias);
  const Quat R_world_site = quaternion_of(sample.orientation) * Quat(R_site_sensor).conjugate();
  out.orientation = wxyz_of(R_world_site);
  if (!offset_m.isZero() && sample.orientation.allFinite())
    out.position = sample.position - R_world_site * offset_m;
  return out;
}

SensorSample TrackerWorld::operator()(const SensorSample& sample) const {
  const Quat R_world_tracker(Eigen::AngleAxisd(yaw_rad, kUp));
  SensorSample out = sample;
  out.orientation = wxyz_of(R_world_tracker * quaternion_of(sample.orientation));
  out.position = R_world_tracker * sample.position + origin_m;
  return out;
}

SensorSample sample_at(const SensorRecording& recording, Eigen::Index index) {
  SensorSample out;
  out.specific_force = recording.specific_force.col(index);
  if (recording.angular_velocity.cols() > 0)
    out.angular_velocity = recording.angular_velocity.col(index);
  if (recording.position.cols() > 0) out.position = recording.position.col(index);
  if (recording.orientation.cols() > 0) out.orientation = recording.orientation.col(index);
  return out;
}

Channels channels_of(const SensorRecording& recording) {
  const auto has_one = [](const auto& values) { return values.array().isFinite().any(); };
  const auto& turn = recording.angular_velocity.array();
  Channels out;
  if (has_one(recording.specific_force)) out = out | Channel::specific_force;
  if ((turn.isFinite() && turn != 0.0).any())
    out = out | Channel::angular_velocity | Channel::gravity_direction;
  if (has_one(recording.position)) out = out | Channel::position;
  if (has_one(recording.orientation)) out = out | Channel::orientation;
  return out;
}

}  // namespace sparse_mocap
