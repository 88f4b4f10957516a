// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/sensors/guided_movements.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap {

// What turns one sensor's readings into those of an ideal sensor at its site.
struct SensorCalibration {
  double scale = 1.0;                     // readings times this are m/s^2
  Mat3 R_site_sensor = Mat3::Identity();  // applied after the scale
  double position_along_bone = 1.0;       // 0 at the pivot of the site's bone, 1 at its end
  bool is_mounting_determined = false;
  bool is_position_determined = false;

  Vec3 gyroscope_bias = Vec3::Zero();  // rad/s, sensor axes

  double gravity = 0.0;             // what the sensor read at rest, in its own unit
  double unrest_mps2 = 0.0;         // while the wearer stood
  double axis_ratio = 1.0;          // how clearly the movements show one axis; 1: not at all
  double position_deviation = 1.0;  // standard deviation of position_along_bone
  double quality = 0.0;             // 0 (nothing is sure) to 1
  std::vector<std::string> notes;   // what could not be determined, why, and what to do
};

// A guided movement as one sensor recorded it, in the sensor's own unit.
struct RecordedMovement {
  const GuidedMovement* movement = nullptr;
  SensorRecording recording;
};

// Where sensors are strapped: 40 % of the way from knee to ankle, at the far end of other bones.
double typical_position_along_bone(const Site& site);

struct CalibrationSettings {
  StandingPose pose = StandingPose::arms_down;
  double height_m = 1.75;              // of the performer: scales the bones of a medium body
  std::optional<StandardBones> bones;  // the performer's own, where they are known
  // Where the movements do not determine it; none: typical_position_along_bone.
  std::optional<double> default_position_along_bone;
};

// Calibrates one sensor: scale and two angles of its mounting from gravity while the performer
// stands, the third from the axis of guided movements, its position along the bone from the lever
// about the point that a movement leaves still. What the movements do not determine is left at its
// default and named in notes. Throws ConfigError as standing_gravity does, and for a height or
// position that cannot be.
SensorCalibration calibrate_sensor(const Site& site, const SensorRecording& standing,
                                   std::span<const RecordedMovement> movements,
                                   const CalibrationSettings& settings);

}  // namespace sparse_mocap
