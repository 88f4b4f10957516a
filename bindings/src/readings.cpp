// SPDX-License-Identifier: GPL-3.0-or-later
#include "readings.hpp"

#include "sparse_mocap/readings/arrival_times.hpp"
#include "sparse_mocap/readings/channel_names.hpp"
#include "sparse_mocap/readings/reading_stream.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {
namespace {

using OptionalDoubles = std::optional<Doubles>;

GravityAverage average_from(const std::string& name) {
  if (name == "causal") return GravityAverage::causal;
  if (name == "whole_take") return GravityAverage::whole_take;
  throw py::value_error("gravity_average is 'causal' or 'whole_take', not '" + name + "'");
}

SensorInput input_from(const std::string& site, const std::vector<std::string>& channels,
                       double position_along_bone, double scale,
                       const OptionalDoubles& R_site_sensor,
                       const OptionalDoubles& gyroscope_bias) {
  SensorInput input;
  input.sensor = {find_site(site), position_along_bone, channels_from(channels)};
  input.correction.scale = scale;
  if (R_site_sensor) {
    require_shape(*R_site_sensor, {3, 3}, "R_site_sensor");
    input.correction.R_site_sensor = columns_of(*R_site_sensor).transpose();
  }
  if (gyroscope_bias) {
    require_shape(*gyroscope_bias, {3}, "gyroscope_bias");
    input.correction.gyroscope_bias = Vec3(gyroscope_bias->data());
  }
  return input;
}

// What an ideal sensor would have measured: forces, angular velocities and orientations, or None.
py::tuple corrected(const SensorInput& input, const Doubles& specific_force,
                    const OptionalDoubles& angular_velocity, const OptionalDoubles& orientation) {
  SensorRecording recording = recording_from(new_array({specific_force.shape(0)}), specific_force,
                                             angular_velocity, std::nullopt, orientation);
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t) {
    const SensorSample ideal = input.correction(sample_at(recording, t));
    recording.specific_force.col(t) = ideal.specific_force;
    if (angular_velocity) recording.angular_velocity.col(t) = ideal.angular_velocity;
    if (orientation) recording.orientation.col(t) = ideal.orientation;
  }
  const auto rows_if = [](bool is_there, const auto& columns) -> py::object {
    return is_there ? py::object(rows_of(columns)) : py::object(py::none());
  };
  return py::make_tuple(rows_of(recording.specific_force),
                        rows_if(angular_velocity.has_value(), recording.angular_velocity),
                        rows_if(orientation.has_value(), recording.orientation));
}

ReadingStream stream_from(const std::vector<SensorInput>& sensors, double rate_hz,
                          const std::string& gravity_average, double tracker_yaw_rad,
                          const OptionalDoubles& tracker_origin_m) {
  ReadingSettings settings;
  settings.rate_hz = rate_hz;
  settings.gravity_average = average_from(gravity_average);
  settings.tracker_world.yaw_rad = tracker_yaw_rad;
  if (tracker_origin_m) {
    require_shape(*tracker_origin_m, {3}, "tracker_origin_m");
    settings.tracker_world.origin_m = Vec3(tracker_origin_m->data());
  }
  return ReadingStream(sensors, settings);
}

int push(ReadingStream& stream, int sensor, const Doubles& times_s, const OptionalDoubles& force,
         const OptionalDoubles& turn, const OptionalDoubles& position,
         const OptionalDoubles& orientation) {
  const SensorRecording recording = recording_from(times_s, force, turn, position, orientation);
  int num_taken = 0;
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t) {
    const double time_s = recording.times_s[static_cast<std::size_t>(t)];
    num_taken += stream.push(sensor, time_s, sample_at(recording, t)) ? 1 : 0;
  }
  return num_taken;
}

int push_arrivals(ReadingStream& stream, int sensor, const Doubles& arrival_s,
                  const Doubles& device_time_s, const OptionalDoubles& force,
                  const OptionalDoubles& turn, const OptionalDoubles& position,
                  const OptionalDoubles& orientation) {
  require_shape(device_time_s, {arrival_s.shape(0)}, "device_time_s");
  const SensorRecording recording = recording_from(arrival_s, force, turn, position, orientation);
  std::vector<Arrival> arrivals;
  for (Eigen::Index t = 0; t < recording.num_samples(); ++t)
    arrivals.push_back({recording.times_s[static_cast<std::size_t>(t)],
                        device_time_s.at(static_cast<py::ssize_t>(t)), sample_at(recording, t)});
  return stream.push_arrivals(sensor, arrivals);
}

Readings told(const ReadingStream& stream, std::vector<Reading> readings) {
  Readings out;
  for (const SensorInput& input : stream.sensors()) out.sensors.push_back(input.sensor);
  out.readings = std::move(readings);
  return out;
}

py::array_t<double> directions(const Doubles& times_s, const Doubles& force, const Doubles& turn,
                               const std::string& average) {
  const SensorRecording recording =
      recording_from(times_s, force, turn, std::nullopt, std::nullopt);
  return rows_of(gravity_directions(recording, average_from(average)));
}

void bind_sensor_input(py::module_& m) {
  py::class_<SensorInput>(m, "SensorInput")
      .def(py::init(&input_from), py::arg("site"),
           py::arg("channels") = std::vector<std::string>{"specific_force"}, py::kw_only(),
           py::arg("position_along_bone") = 1.0, py::arg("scale") = 1.0,
           py::arg("R_site_sensor") = py::none(), py::arg("gyroscope_bias") = py::none())
      .def_property_readonly(
          "site",
          [](const SensorInput& input) {
            return std::string(all_sites()[static_cast<std::size_t>(input.sensor.site)].name);
          })
      .def_property_readonly(
          "position_along_bone",
          [](const SensorInput& input) { return input.sensor.position_along_bone; })
      .def_property_readonly(
          "channels", [](const SensorInput& input) { return names_of(input.sensor.channels); })
      .def("corrected", &corrected, py::arg("specific_force"),
           py::arg("angular_velocity") = py::none(), py::arg("orientation") = py::none());
}

}  // namespace

void bind_readings(py::module_& m) {
  m.attr("LARGEST_CLOCK_DRIFT") = kLargestClockDrift;
  bind_reading_values(m);
  bind_sensor_input(m);
  py::class_<ReadingStream>(m, "ReadingStream")
      .def(py::init(&stream_from), py::arg("sensors"), py::arg("rate_hz"), py::kw_only(),
           py::arg("gravity_average") = "causal", py::arg("tracker_yaw_rad") = 0.0,
           py::arg("tracker_origin_m") = py::none())
      .def("push", &push, py::arg("sensor"), py::arg("times_s"),
           py::arg("specific_force") = py::none(), py::arg("angular_velocity") = py::none(),
           py::arg("position") = py::none(), py::arg("orientation") = py::none())
      .def("push_arrivals", &push_arrivals, py::arg("sensor"), py::arg("arrival_s"),
           py::arg("device_time_s"), py::arg("specific_force") = py::none(),
           py::arg("angular_velocity") = py::none(), py::arg("position") = py::none(),
           py::arg("orientation") = py::none())
      .def(
          "ready",
          [](ReadingStream& stream, double now_s) { return told(stream, stream.ready(now_s)); },
          py::arg("now_s"))
      .def("flush", [](ReadingStream& stream) { return told(stream, stream.flush()); })
      .def_property_readonly("delay_s", &ReadingStream::delay_s)
      .def_property_readonly("rate_hz", &ReadingStream::rate_hz);
  m.def(
      "channels_of",
      [](const Doubles& specific_force, const OptionalDoubles& turn,
         const OptionalDoubles& position, const OptionalDoubles& orientation) {
        return names_of(channels_of(recording_from(new_array({specific_force.shape(0)}),
                                                   specific_force, turn, position, orientation)));
      },
      py::arg("specific_force"), py::arg("angular_velocity") = py::none(),
      py::arg("position") = py::none(), py::arg("orientation") = py::none());
  m.def("gravity_directions", &directions, py::arg("times_s"), py::arg("specific_force"),
        py::arg("angular_velocity"), py::kw_only(), py::arg("average") = "causal");
  m.def(
      "spread_evenly",
      [](const Doubles& arrival_s) {
        require_shape(arrival_s, {-1}, "arrival_s");
        return array_of(spread_evenly(span_of(arrival_s)));
      },
      py::arg("arrival_s"));
  m.def(
      "host_times",
      [](const Doubles& device_s, const Doubles& arrival_s) {
        require_shape(device_s, {-1}, "device_s");
        require_shape(arrival_s, {device_s.shape(0)}, "arrival_s");
        const HostTimes found = host_times(span_of(device_s), span_of(arrival_s));
        return py::make_tuple(array_of(found.times_s), found.rate);
      },
      py::arg("device_s"), py::arg("arrival_s"));
}

}  // namespace sparse_mocap::python
