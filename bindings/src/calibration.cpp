// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/calibration.hpp"

#include "common.hpp"

namespace sparse_mocap::python {
namespace {

// times_s (T,), specific_force (T, 3), angular_velocity (T, 3) or None.
using BoundRecording = std::tuple<Doubles, Doubles, std::optional<Doubles>>;

SensorRecording recording_of(const BoundRecording& bound) {
  const auto& [times_s, force, turn] = bound;
  require_shape(times_s, {-1}, "times_s");
  require_shape(force, {times_s.shape(0), 3}, "specific_force");
  if (turn) require_shape(*turn, {times_s.shape(0), 3}, "angular_velocity");
  SensorRecording out;
  out.times_s.assign(times_s.data(), times_s.data() + times_s.size());
  out.specific_force = columns_of(force);
  if (turn) out.angular_velocity = columns_of(*turn);
  return out;
}

py::dict told(const SensorCalibration& calibration) {
  auto rotation = new_array({3, 3});
  auto R = rotation.mutable_unchecked<2>();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      R(row, column) = calibration.R_site_sensor(row, column);
  py::dict out;
  out["scale"] = calibration.scale;
  out["R_site_sensor"] = rotation;
  out["position_along_bone"] = calibration.position_along_bone;
  out["is_mounting_determined"] = calibration.is_mounting_determined;
  out["is_position_determined"] = calibration.is_position_determined;
  auto bias = new_array({3});
  std::copy(calibration.gyroscope_bias.data(), calibration.gyroscope_bias.data() + 3,
            bias.mutable_data());
  out["gyroscope_bias"] = bias;
  out["gravity"] = calibration.gravity;
  out["unrest_mps2"] = calibration.unrest_mps2;
  out["axis_ratio"] = calibration.axis_ratio;
  out["position_deviation"] = calibration.position_deviation;
  out["quality"] = calibration.quality;
  out["notes"] = calibration.notes;
  return out;
}

py::dict calibrate(const std::string& site, const std::string& pose, const BoundRecording& standing,
                   const std::vector<std::pair<std::string, BoundRecording>>& movements,
                   double height_m, std::optional<double> default_position_along_bone,
                   const std::optional<Skeleton>& body) {
  std::vector<RecordedMovement> recorded;
  for (const auto& [name, recording] : movements)
    recorded.push_back({&find_guided_movement(name), recording_of(recording)});
  CalibrationSettings settings;
  settings.pose = find_standing_pose(pose);
  settings.height_m = height_m;
  settings.default_position_along_bone = default_position_along_bone;
  if (body) settings.bones = bones_of(*body);
  return told(calibrate_sensor(all_sites()[static_cast<std::size_t>(find_site(site))],
                               recording_of(standing), recorded, settings));
}

}  // namespace

void bind_calibration(py::module_& m) {
  m.def(
      "standing_pose_names",
      [] {
        return std::vector<std::string>(standing_pose_names().begin(), standing_pose_names().end());
      },
      "Returns the poses that a performer may stand in during a calibration.");
  m.def(
      "guided_movements",
      [] {
        py::dict out;
        for (const auto& movement : guided_movements()) {
          std::vector<std::string> sites;
          for (const auto& turn : movement.turns) sites.emplace_back(turn.site);
          out[py::str(std::string(movement.name))] =
              py::make_tuple(std::string(movement.instruction), sites);
        }
        return out;
      },
      "Returns each guided movement's instruction and the sites that it calibrates, by its name.");
  m.def("calibrate_sensor", &calibrate, py::arg("site"), py::arg("pose"), py::arg("standing"),
        py::arg("movements"), py::arg("height_m"), py::arg("default_position_along_bone"),
        py::arg("body") = py::none(),
        R"doc(Returns one sensor's calibration: the fields of SensorCalibration but its site.

standing and each named movement are a recording: times_s (T,), specific_force (T, 3) in m/s^2
or g, angular_velocity (T, 3) in rad/s or None, in the sensor's axes. Bones are those of body,
or of a medium body of that height. default_position_along_bone, 0 to 1, is used where the
movements do not determine it; None: one that is usual for the site.

Raises ConfigError for an unknown site, pose or movement, for a height or position out of range,
and for a performer who does not stand still long enough.)doc");
}

}  // namespace sparse_mocap::python
