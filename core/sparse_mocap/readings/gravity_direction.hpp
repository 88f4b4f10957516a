// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <limits>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// The direction of gravity, as a unit vector against it (up), in a sensor's axes, from
// accelerometer and gyroscope together.
//
// The gyroscope carries along a frame that stays put in the world but for a slow drift. There the
// wearer's own accelerations average out and gravity remains, as in the inclination step of VQF
// (Laidig, Seel: Information Fusion 91, 2023). No magnetometer, hence no heading.
class GravityDirectionFilter {
 public:
  static constexpr double kTimeConstant_s = 3.0;  // of the average
  static constexpr double kUnsure_s = 0.5;        // after a beginning nothing has averaged out yet
  static constexpr double kLongestGap_s = 0.25;   // a longer silence is a new beginning

  // The next sample: s, m/s^2, rad/s, sensor axes; time must ascend, or it begins anew. Returns a
  // unit vector; NaN while it is unsure, and until the gyroscope has turned at all (a device
  // without one may send zeros). A sample that is not finite is passed over, with NaN.
  Vec3 update(double time_s, const Vec3& specific_force, const Vec3& angular_velocity);

  void reset() { *this = GravityDirectionFilter(); }

 private:
  double last_s_ = std::numeric_limits<double>::quiet_NaN();
  double age_s_ = 0.0;
  bool has_turned_ = false;
  Vec3 last_rate_ = Vec3::Zero();
  Quat R_held_sensor_ = Quat::Identity();
  Vec3 mean_ = Vec3::Zero();  // of the specific force, held frame
};

// Whether a sample's direction is averaged over the samples before it alone, as they can be had
// live, or over those after it as well: surer at the beginning, and never unsure.
enum class GravityAverage { causal, whole_take };

// The directions of a whole recording, 3 x samples. NaN where a sample is not finite, where the
// causal filter is unsure, and everywhere when the gyroscope never turned or there is none.
Eigen::Matrix3Xd gravity_directions(const SensorRecording& recording, GravityAverage average);

}  // namespace sparse_mocap
