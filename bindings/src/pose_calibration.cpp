// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_calibration.hpp"

#include "common.hpp"
#include "sparse_mocap/liu2011/calibration_poses.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {
namespace {

using namespace liu2011;

// The pose's name, positions (S, 3) m and rotations (S, 3, 3); NaN where there is none.
using BoundPose = std::tuple<std::string, Doubles, Doubles>;

py::array_t<double> matrix_array(const Mat3& R) {
  auto out = new_array({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.mutable_at(row, column) = R(row, column);
  return out;
}

HeldPose held_from(const BoundPose& bound, py::ssize_t num_sensors) {
  const auto& [name, positions, rotations] = bound;
  require_shape(positions, {num_sensors, 3}, "positions");
  require_shape(rotations, {num_sensors, 3, 3}, "rotations");
  HeldPose held{find_calibration_pose(name), {}};
  for (py::ssize_t j = 0; j < num_sensors; ++j) {
    HeldSensor sensor;
    for (int row = 0; row < 3; ++row) {
      sensor.position[row] = positions.at(j, row);
      for (int column = 0; column < 3; ++column)
        sensor.R_world_sensor(row, column) = rotations.at(j, row, column);
    }
    sensor.has_position = sensor.position.allFinite();
    sensor.has_orientation = sensor.R_world_sensor.allFinite();
    held.sensors.push_back(sensor);
  }
  return held;
}

py::dict sensor_dict(const CalibratedSensor& sensor) {
  py::dict out;
  out["R_site_sensor"] = matrix_array(sensor.R_site_sensor);
  out["offset_m"] = array_of({sensor.offset_m.data(), 3});
  out["mounting_deviation_deg"] = sensor.mounting_deviation_deg;
  out["offset_deviation_m"] = array_of({sensor.offset_deviation_m.data(), 3});
  out["is_mounting_determined"] = sensor.is_mounting_determined;
  out["is_offset_determined"] = sensor.is_offset_determined;
  return out;
}

py::dict told(const PoseCalibration& found) {
  auto bones = new_array({kNumStandardJoints, 3});
  for (py::ssize_t j = 0; j < kNumStandardJoints; ++j)
    for (int k = 0; k < 3; ++k)
      bones.mutable_at(j, k) = found.bones[static_cast<std::size_t>(j)][k];
  py::list sensors;
  for (const auto& sensor : found.sensors) sensors.append(sensor_dict(sensor));
  py::dict out;
  out["bones"] = bones;
  out["bone_deviation_m"] =
      array_of({found.deviation_m.data(), static_cast<std::size_t>(kNumBoneLengths)});
  out["is_bone_determined"] =
      std::vector<bool>(found.is_determined.begin(), found.is_determined.end());
  out["sensors"] = sensors;
  out["missed_deg"] = found.missed_deg;
  out["imitation_deg"] = found.imitation_deg;
  out["yaw_rad"] = found.yaw_rad;
  out["are_poses_alike"] = found.are_poses_alike;
  return out;
}

py::dict calibrate_from_poses(const std::vector<std::string>& sites,
                              const std::vector<BoundPose>& poses,
                              const std::shared_ptr<Model>& model) {
  std::vector<Sensor> sensors;
  for (const auto& site : sites) sensors.push_back({find_site(site)});
  std::vector<HeldPose> held;
  for (const auto& pose : poses)
    held.push_back(held_from(pose, static_cast<py::ssize_t>(sites.size())));
  const BoneLengthModel lengths = model ? bone_lengths_in(*model) : published_bone_lengths();
  PoseCalibration found;
  {
    const py::gil_scoped_release release;
    found = calibrated_from_poses(lengths, sensors, held, {});
  }
  return told(found);
}

py::list pose_list() {
  py::list out;
  for (const CalibrationPose& pose : calibration_poses()) {
    auto rotations = new_array({kNumStandardJoints, 4});
    for (py::ssize_t j = 0; j < kNumStandardJoints; ++j) {
      const Quat R(pose.rotations[static_cast<std::size_t>(j)]);
      const Eigen::Vector4d wxyz(R.w(), R.x(), R.y(), R.z());
      for (int k = 0; k < 4; ++k) rotations.mutable_at(j, k) = wxyz[k];
    }
    out.append(py::make_tuple(std::string(pose.name), std::string(pose.instruction), rotations));
  }
  return out;
}

}  // namespace

void bind_pose_calibration(py::module_& m) {
  m.def(
      "calibration_poses", &pose_list,
      R"doc(Returns the poses of a calibration: name, instruction, rotations (21, 4) of the joints.

Rotations of the standard skeleton's joints, w x y z, relative to the parent; facing +z.)doc");
  m.def("calibrate_from_poses", &calibrate_from_poses, py::arg("sites"), py::arg("poses"),
        py::arg("model") = py::none(),
        R"doc(Returns bones and mountings from held poses (Liu et al. 2011, section 4).

poses: the name of each, where the S trackers were while it was held, (S, 3) m, and their
rotations R_world_sensor (S, 3, 3), NaN where a tracker says nothing. model: bone lengths that
liu2011 was trained on; None: published proportions.

``bones`` (21, 3) m, ``bone_deviation_m`` and ``is_bone_determined`` (20,) of all bones but the
root's; ``sensors``: a dict each with R_site_sensor (3, 3), offset_m (3,) in the site's axes,
their deviations and whether the poses determine them; ``missed_deg``: how far the limbs with
sensors were from each shown pose, RMS; ``imitation_deg``: the deviation of each angle from them;
``yaw_rad`` of the performer's front in the trackers' world; ``are_poses_alike``.

Raises ConfigError for an unknown site or pose, without sensors or poses, and when no tracker says
anything in a pose; FormatError for a model without bone lengths.)doc");
}

}  // namespace sparse_mocap::python
