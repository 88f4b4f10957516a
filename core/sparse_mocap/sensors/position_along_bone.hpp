// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// Where a sensor is, seen from a point of its rigid bone that stays where it is.
struct Lever {
  double along_m = 0.0;      // along x of the site
  double deviation_m = 1e9;  // standard deviation of along_m
  // The part of what turning alone leaves unexplained that the lever explains, 0 to 1.
  double explained = 0.0;
};

// A sensor on a bone that turns about a still point reads gravity and, with r from that point,
// alpha x r + omega x (omega x r): linear in r and in gravity at the beginning of each stretch of
// a few seconds, through which the gyroscope carries the orientation. recording is in the axes of
// the site, in m/s^2, without the gyroscope's bias. Needs the gyroscope.
Lever lever_from(const SensorRecording& recording);

}  // namespace sparse_mocap
