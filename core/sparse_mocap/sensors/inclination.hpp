// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// The direction against gravity in a sensor's axes, from accelerometer and gyroscope together.
//
// The gyroscope carries along a frame that stays put in the world but for a slow drift. There the
// wearer's own accelerations average out and gravity remains, as in the inclination step of VQF
// (Laidig, Seel: Information Fusion 91, 2023). No magnetometer, hence no heading.
class InclinationFilter {
 public:
  static constexpr double kTimeConstant_s = 3.0;  // of the average
  static constexpr double kUnsure_s = 0.5;        // after a beginning nothing has averaged out yet
  static constexpr double kLongestGap_s = 0.25;   // a longer silence is a new beginning

  // The next sample: s, m/s^2, rad/s, sensor axes; time must ascend, or it begins anew. Returns a
  // unit vector; NaN while it is unsure, and until the gyroscope has turned at all (a device
  // without one may send zeros). A sample that is not finite is passed over, with NaN.
  Vec3 update(double time_s, const Vec3& specific_force, const Vec3& angular_velocity);

  void reset() { *this = InclinationFilter(); }

 private:
  double last_s_ = std::numeric_limits<double>::quiet_NaN();
  double age_s_ = 0.0;
  bool has_turned_ = false;
  Vec3 last_rate_ = Vec3::Zero();
  Quat R_held_sensor_ = Quat::Identity();
  Vec3 mean_ = Vec3::Zero();  // of the specific force, held frame
};

// The filter's answers to a whole recording. 3 x samples; all NaN when there is no gyroscope.
Eigen::Matrix3Xd inclinations_online(const SensorRecording& recording);

// The same where each sample's average reaches both ways: surer at the beginning, and never unsure.
// NaN where a sample is not finite, and everywhere when the gyroscope never turned.
Eigen::Matrix3Xd inclinations_offline(const SensorRecording& recording);

}  // namespace sparse_mocap
