// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>

namespace sparse_mocap {

// What a sensor can measure, or what is known from its measurements.
enum class Channel : unsigned {
  specific_force = 1U << 0,     // accelerometer; includes gravity
  angular_velocity = 1U << 1,   // gyroscope
  gravity_direction = 1U << 2,  // accelerometer and gyroscope together
  orientation = 1U << 3,        // what a tracker fuses for itself
  position = 1U << 4,           // optical or radio tracking
};

// A set of channels.
class Channels {
 public:
  constexpr Channels() = default;
  constexpr Channels(Channel channel) : bits_(static_cast<unsigned>(channel)) {}  // NOLINT

  constexpr bool has(Channel channel) const {
    return (bits_ & static_cast<unsigned>(channel)) != 0;
  }
  constexpr bool is_empty() const { return bits_ == 0; }
  constexpr bool has_all(Channels other) const { return (bits_ & other.bits_) == other.bits_; }

  friend constexpr Channels operator|(Channels a, Channels b) {
    a.bits_ |= b.bits_;
    return a;
  }
  friend constexpr Channels operator&(Channels a, Channels b) {
    a.bits_ &= b.bits_;
    return a;
  }
  friend constexpr bool operator==(Channels a, Channels b) = default;

 private:
  unsigned bits_ = 0;
};

constexpr Channels operator|(Channel a, Channel b) { return Channels(a) | Channels(b); }

// A sensor of a performance: where it is worn, and what it gives.
struct Sensor {
  int site = 0;                      // index in all_sites()
  double position_along_bone = 1.0;  // 0 at the carrying bone's pivot, 1 at its end
  Channels channels = Channel::specific_force;
};

// What all sensors read at one instant: one column a sensor, in its own axes unless said otherwise;
// NaN where a sensor lacks the channel or is silent.
struct Reading {
  Reading() = default;
  explicit Reading(Eigen::Index num_sensors) {
    constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
    for (auto* vectors : {&specific_force, &angular_velocity, &gravity_direction, &position})
      vectors->setConstant(3, num_sensors, kAbsent);
    orientation.setConstant(4, num_sensors, kAbsent);
  }

  Eigen::Index num_sensors() const { return specific_force.cols(); }

  double time_s = 0.0;
  Eigen::Matrix3Xd specific_force;     // m/s^2
  Eigen::Matrix3Xd angular_velocity;   // rad/s
  Eigen::Matrix3Xd gravity_direction;  // unit vectors, against gravity (up)
  Eigen::Matrix3Xd position;           // m, world
  Eigen::Matrix4Xd orientation;        // R_world_sensor, w x y z
};

}  // namespace sparse_mocap
