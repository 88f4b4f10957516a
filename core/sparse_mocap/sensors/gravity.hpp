// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// What a sensor reads while its wearer stands still.
struct StandingGravity {
  double magnitude = 0.0;              // as the sensor states it
  bool is_in_g = false;                // the sensor reads g, not m/s^2
  double scale = 1.0;                  // readings times this are m/s^2
  Vec3 up = Vec3::Zero();              // unit, against gravity, in the sensor's axes
  double unrest_mps2 = 0.0;            // how far readings stray from their mean
  Vec3 gyroscope_bias = Vec3::Zero();  // rad/s
};

// Further from 1 g than this part, a sensor at rest is broken, badly set up, or not at rest.
inline constexpr double kLargestGravityError = 0.15;

// The gravity in the quietest second of a recording. Throws ConfigError with the measured number
// when the recording is too short, not still, or its magnitude is neither 1 g nor 9.81 m/s^2
// within kLargestGravityError.
StandingGravity standing_gravity(const SensorRecording& standing);

}  // namespace sparse_mocap
