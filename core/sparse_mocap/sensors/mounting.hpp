// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "sparse_mocap/sensors/guided_movements.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// The axis about which a sensor turned during a movement; its sign is not known.
struct TurningAxis {
  Vec3 axis = Vec3::Zero();  // unit, sensor axes
  // How far the movement is from determining the axis: the second largest spread across the axis
  // as a part of what is left of it, 1 when no direction stands out.
  double ratio = 1.0;
  double sweep_rad = 0.0;  // how far it turned, root mean square
  bool is_from_gyroscope = false;
};

// From angular velocity when there is a gyroscope: the direction that has most of it. From specific
// force (m/s^2) otherwise: a limb that turns about one axis keeps its readings in the plane across.
TurningAxis turning_axis(const SensorRecording& movement, const Vec3& gyroscope_bias);

// Below these a movement does not determine an axis.
inline constexpr double kSmallestAxisRatio = 2.0;
inline constexpr double kSmallestSweep_rad = 0.14;

// One movement as one sensor saw it; readings in m/s^2.
struct ObservedTurn {
  GuidedTurn turn;
  SensorRecording recording;
};

struct Mounting {
  Mat3 R_site_sensor = Mat3::Identity();
  bool is_determined = false;  // all three angles; else about gravity it is as the site says
  double axis_ratio = 1.0;     // of the movement that was used, else the best there was
  double sweep_rad = 0.0;
  bool is_from_gyroscope = false;
};

// Two angles from gravity (up: what the site and what the sensor call up), the third from the
// movement whose axis stands out most.
Mounting mounting_from(const Vec3& up_site, const Vec3& up_sensor, const Vec3& gyroscope_bias,
                       std::span<const ObservedTurn> turns);

}  // namespace sparse_mocap
