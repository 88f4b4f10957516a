// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/sensors/gravity.hpp"
#include "sparse_mocap/sensors/mounting.hpp"
#include "sparse_mocap/sensors/position_along_bone.hpp"

namespace sparse_mocap {
namespace {

constexpr double kTemplateHeight_m = 1.75;
constexpr double kLargestPositionDeviation = 0.08;
constexpr double kSmallestExplained = 0.7;
constexpr double kBeyondBone = 0.15;  // how far off the bone a position may come out

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void check(const CalibrationSettings& settings) {
  if (!(settings.height_m >= 0.5 && settings.height_m <= 2.5))
    throw ConfigError("height_m is " + number("%g", settings.height_m) +
                      "; it must be from 0.5 to 2.5");
  const double position = settings.default_position_along_bone.value_or(1.0);
  if (!(position >= 0.0 && position <= 1.0))
    throw ConfigError("the position along the bone is " + number("%g", position) +
                      "; it must be from 0 to 1");
}

std::vector<ObservedTurn> observed_turns(const Site& site,
                                         std::span<const RecordedMovement> movements,
                                         double scale) {
  std::vector<ObservedTurn> turns;
  for (const auto& recorded : movements) {
    const GuidedTurn* turn = turn_of(*recorded.movement, site.name);
    if (turn == nullptr) continue;
    turns.push_back({*turn, recorded.recording});
    turns.back().recording.specific_force *= scale;
  }
  return turns;
}

SensorRecording in_site_axes(SensorRecording recording, const Mat3& R_site_sensor,
                             const Vec3& gyroscope_bias) {
  recording.specific_force = R_site_sensor * recording.specific_force;
  recording.angular_velocity =
      R_site_sensor * (recording.angular_velocity.colwise() - gyroscope_bias);
  return recording;
}

double bone_length_m(const Site& site, const CalibrationSettings& settings) {
  const auto carrier = static_cast<std::size_t>(site.carrier);
  if (settings.bones) return (*settings.bones)[carrier].norm();
  return template_bones()[carrier].norm() * settings.height_m / kTemplateHeight_m;
}

bool is_on_bone(double position) {
  return position >= -kBeyondBone && position <= 1.0 + kBeyondBone;
}

// Who was asked to squat may have bent the knees backwards: the point that stayed still is then
// another one that movements of this site leave still, the only one that puts the sensor on its
// bone.
double position_on_bone(const GuidedTurn& turn, double lever) {
  if (is_on_bone(*turn.still_position + lever)) return *turn.still_position + lever;
  for (const auto& movement : guided_movements()) {
    const GuidedTurn* other = turn_of(movement, turn.site);
    if (other != nullptr && other->still_position && is_on_bone(*other->still_position + lever))
      return *other->still_position + lever;
  }
  return *turn.still_position + lever;
}

// The position that the most certain movement shows.
void find_position(std::span<const ObservedTurn> turns, const Vec3& gyroscope_bias, double bone_m,
                   SensorCalibration& out) {
  for (const auto& observed : turns) {
    if (!observed.turn.still_position || !observed.recording.has_gyroscope()) continue;
    const Lever lever =
        lever_from(in_site_axes(observed.recording, out.R_site_sensor, gyroscope_bias));
    const double position = position_on_bone(observed.turn, lever.along_m / bone_m);
    const double deviation = lever.deviation_m / bone_m;
    if (lever.explained < kSmallestExplained || !is_on_bone(position)) continue;
    if (deviation >= out.position_deviation) continue;
    out.position_deviation = deviation;
    if (deviation > kLargestPositionDeviation) continue;
    out.position_along_bone = std::clamp(position, 0.0, 1.0);
    out.is_position_determined = true;
  }
}

void note_what_is_missing(std::span<const ObservedTurn> turns, const Mounting& mounting,
                          const SensorCalibration& calibration, std::vector<std::string>& notes) {
  if (!mounting.is_determined && turns.empty())
    notes.push_back(
        "no guided movement turns it, so how it is turned about the vertical is taken "
        "as the site says");
  else if (!mounting.is_determined)
    notes.push_back(
        "the movements do not determine how it is turned about the vertical (its axis "
        "stands out " +
        number("%.1f", mounting.axis_ratio) +
        " times, 2 are needed; "
        "it turned " +
        number("%.0f", mounting.sweep_rad / kRadiansPerDegree) +
        " degrees, 8 are needed): taken as the site says; move more, about one axis");
  if (calibration.is_position_determined) return;
  const bool has_gyroscope = std::any_of(turns.begin(), turns.end(), [](const ObservedTurn& turn) {
    return turn.recording.has_gyroscope();
  });
  notes.push_back(
      std::string("the movements do not determine its position along the bone (") +
      (has_gyroscope ? "no point of it stayed still long enough" : "that takes a gyroscope") +
      "): taken as " + number("%.2f", calibration.position_along_bone));
}

}  // namespace

double typical_position_along_bone(const Site& site) {
  using namespace standard_joint;
  return site.carrier == ltibia || site.carrier == rtibia ? 0.4 : 1.0;
}

SensorCalibration calibrate_sensor(const Site& site, const SensorRecording& standing,
                                   std::span<const RecordedMovement> movements,
                                   const CalibrationSettings& settings) {
  check(settings);
  const StandingGravity gravity = standing_gravity(standing);
  const auto turns = observed_turns(site, movements, gravity.scale);
  const Mounting mounting = mounting_from(up_while_standing(site, settings.pose), gravity.up,
                                          gravity.gyroscope_bias, turns);
  SensorCalibration out;
  out.scale = gravity.scale;
  out.gravity = gravity.magnitude;
  out.unrest_mps2 = gravity.unrest_mps2;
  out.R_site_sensor = mounting.R_site_sensor;
  out.is_mounting_determined = mounting.is_determined;
  out.axis_ratio = mounting.axis_ratio;
  out.gyroscope_bias = gravity.gyroscope_bias;
  out.position_along_bone =
      settings.default_position_along_bone.value_or(typical_position_along_bone(site));
  if (mounting.is_determined)
    find_position(turns, gravity.gyroscope_bias, bone_length_m(site, settings), out);
  note_what_is_missing(turns, mounting, out, out.notes);
  const double still = std::exp(-gravity.unrest_mps2 / 0.5);
  const double mounted = mounting.is_determined ? 1.0 - 1.0 / mounting.axis_ratio : 0.0;
  const double positioned = out.is_position_determined ? 1.0 - out.position_deviation : 0.0;
  out.quality = still * (0.2 + 0.5 * mounted + 0.3 * positioned);
  return out;
}

}  // namespace sparse_mocap
