// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/sensor_turning.hpp"

#include <limits>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/base/quaternions.hpp"

namespace sparse_mocap::path_regression {
namespace {

constexpr double kLongestStep_s = 0.25;  // beyond it nobody knows how a sensor turned meanwhile

Quat turned_by(const Vec3& rate_radps, double dt_s) {
  const double angle_rad = rate_radps.norm() * dt_s;
  if (!(angle_rad > 0.0)) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle_rad, rate_radps.normalized()));
}

Eigen::Vector4d wxyz(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

bool has_own_heading(const Sensor& sensor, bool with_own_headings) {
  return with_own_headings && !sensor.channels.has(Channel::orientation) &&
         sensor.channels.has_all(Channel::angular_velocity | Channel::gravity_direction);
}

std::vector<Sensor> with_turning(std::vector<Sensor> sensors, bool with_own_headings) {
  for (Sensor& sensor : sensors) {
    if (has_own_heading(sensor, with_own_headings))
      sensor.channels = sensor.channels | Channel::orientation;
    else if (sensor.channels.has(Channel::orientation))
      sensor.channels = sensor.channels | Channel::gravity_direction | Channel::angular_velocity;
  }
  return sensors;
}

const Reading& TurningOf::operator()(const Reading& measured) {
  told_ = measured;
  for (std::size_t s = 0; s < sensors_.size(); ++s) {
    const auto column = static_cast<Eigen::Index>(s);
    if (has_own_heading(sensors_[s], with_own_headings_))
      turn_on(measured, column);
    else if (sensors_[s].channels.has(Channel::orientation))
      tell_from_orientation(measured, column);
  }
  before_ = told_;
  return told_;
}

void TurningOf::tell_from_orientation(const Reading& measured, Eigen::Index s) {
  const Channels channels = sensors_[static_cast<std::size_t>(s)].channels;
  if (!measured.orientation.col(s).allFinite()) return;
  const Quat R_world_sensor = quaternion_of(measured.orientation.col(s)).normalized();
  if (!channels.has(Channel::gravity_direction))
    told_.gravity_direction.col(s) = R_world_sensor.conjugate() * kUp;
  if (channels.has(Channel::angular_velocity) || before_.num_sensors() == 0) return;
  const Eigen::Vector4d last = before_.orientation.col(s);
  if (!last.allFinite()) return;
  const Eigen::AngleAxisd turn(quaternion_of(last).normalized().conjugate() * R_world_sensor);
  told_.angular_velocity.col(s) = turn.angle() * turn.axis() / (measured.time_s - before_.time_s);
}

void TurningOf::turn_on(const Reading& measured, Eigen::Index s) {
  told_.orientation.col(s).setConstant(std::numeric_limits<double>::quiet_NaN());
  const Vec3 rate_radps = measured.angular_velocity.col(s), up = measured.gravity_direction.col(s);
  if (!rate_radps.allFinite() || !(up.norm() > 0.0)) return;
  Quat R_own_sensor = Quat::Identity();
  if (before_.num_sensors() > 0 && before_.orientation.col(s).allFinite()) {
    const double dt_s = measured.time_s - before_.time_s;
    if (dt_s > kLongestStep_s) return;
    const Vec3 before_radps = before_.angular_velocity.col(s);
    R_own_sensor = quaternion_of(before_.orientation.col(s)) *
                   turned_by(0.5 * (before_radps + rate_radps), dt_s);
  }
  const Quat upright = Quat::FromTwoVectors(R_own_sensor * up, kUp);
  told_.orientation.col(s) = wxyz((upright * R_own_sensor).normalized());
}

}  // namespace sparse_mocap::path_regression
