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
                       const OptionalDoubles& R_site_sensor, const OptionalDoubles& gyroscope_bias,
                       const OptionalDoubles& offset_m) {
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
  if (offset_m) {
    require_shape(*offset_m, {3}, "offset_m");
    input.correction.offset_m = Vec3(offset_m->data());
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
  py::class_<SensorInput>(
      m, "SensorInput",
      "A sensor of a performance: its location, the channels to use and how to correct them.")
      .def(py::init(&input_from), py::arg("site"),
           py::arg("channels") = std::vector<std::string>{"specific_force"}, py::kw_only(),
           py::arg("position_along_bone") = 1.0, py::arg("scale") = 1.0,
           py::arg("R_site_sensor") = py::none(), py::arg("gyroscope_bias") = py::none(),
           py::arg("offset_m") = py::none(),
           R"doc(Takes a site of site_names() and channels of CHANNEL_NAMES.

position_along_bone is 0 at the joint near the body and 1 at the bone's far end. Specific
forces times scale are m/s^2; R_site_sensor (3, 3) is applied after the scale;
gyroscope_bias (3,) is in rad/s and the sensor's own axes; offset_m (3,) is where the sensor
sits, seen from its site, in the site's axes. Raises ConfigError for an unknown site or
channel.)doc")
      .def_property_readonly(
          "site",
          [](const SensorInput& input) {
            return std::string(all_sites()[static_cast<std::size_t>(input.sensor.site)].name);
          },
          "The sensor location, one of site_names().")
      .def_property_readonly(
          "position_along_bone",
          [](const SensorInput& input) { return input.sensor.position_along_bone; },
          "From 0 at the joint near the body to 1 at the bone's far end.")
      .def_property_readonly(
          "channels", [](const SensorInput& input) { return names_of(input.sensor.channels); },
          "The channels to use, in the order of CHANNEL_NAMES.")
      .def(
          "corrected", &corrected, py::arg("specific_force"),
          py::arg("angular_velocity") = py::none(), py::arg("orientation") = py::none(),
          R"doc(Returns the values that an ideal sensor would have measured, None for what is not given.

specific_force (T, 3), in m/s^2 once scaled; angular_velocity (T, 3) rad/s; orientation
(T, 4) R_world_sensor, w x y z. Given in the sensor's axes, returned in its site's.)doc");
}

void bind_stream(py::module_& m) {
  py::class_<ReadingStream>(
      m, "ReadingStream",
      R"doc(Turns sensors' samples into readings at a fixed rate, live and for whole takes.

Samples are corrected, low-passed and resampled. Where a sensor sent nothing for longer than
0.1 s, its readings are NaN.)doc")
      .def(py::init(&stream_from), py::arg("sensors"), py::arg("rate_hz"), py::kw_only(),
           py::arg("gravity_average") = "causal", py::arg("tracker_yaw_rad") = 0.0,
           py::arg("tracker_origin_m") = py::none(),
           R"doc(gravity_average: "causal" averages over the past, "whole_take" over the whole take.

With the latter flush() returns all readings. tracker_yaw_rad and tracker_origin_m (3,)
place the tracker's world, of positions and orientations, in the performer's: a turn about
the vertical, then a shift. Raises ValueError without sensors, for a sensor without
channels, and for a rate that is not positive.)doc")
      .def("push", &push, py::arg("sensor"), py::arg("times_s"),
           py::arg("specific_force") = py::none(), py::arg("angular_velocity") = py::none(),
           py::arg("position") = py::none(), py::arg("orientation") = py::none(),
           R"doc(Takes N samples of one sensor by its index; returns how many it used.

times_s (N,) are on the clock that all sensors share. specific_force and angular_velocity
(N, 3) are in the sensor's axes and units, position (N, 3) m and orientation (N, 4)
R_world_sensor in the tracker's world. Samples that are not finite or not after the sensor's
last one are skipped.)doc")
      .def(
          "push_arrivals", &push_arrivals, py::arg("sensor"), py::arg("arrival_s"),
          py::arg("device_time_s"), py::arg("specific_force") = py::none(),
          py::arg("angular_velocity") = py::none(), py::arg("position") = py::none(),
          py::arg("orientation") = py::none(),
          R"doc(Takes N samples that arrived together, as push does; the shared clock is the host's.

arrival_s (N,) is when they were received; device_time_s (N,) is the device's clock,
unwrapped, or NaN for a device without one. Returns how many samples it used.)doc")
      .def(
          "ready",
          [](ReadingStream& stream, double now_s) { return told(stream, stream.ready(now_s)); },
          py::arg("now_s"),
          R"doc(Returns the next readings that are complete at now_s, on the clock of the samples.

A late sensor is waited for 0.1 s; then the readings come without it.)doc")
      .def(
          "flush", [](ReadingStream& stream) { return told(stream, stream.flush()); },
          "Returns all remaining readings, up to the last sample, when the performance has ended.")
      .def_property_readonly(
          "delay_s", &ReadingStream::delay_s,
          "How long after its time a reading is ready when no sensor is late, in s.")
      .def_property_readonly("rate_hz", &ReadingStream::rate_hz, "Readings a second.");
}

void bind_recording_functions(py::module_& m) {
  m.def(
      "channels_of",
      [](const Doubles& specific_force, const OptionalDoubles& turn,
         const OptionalDoubles& position, const OptionalDoubles& orientation) {
        return names_of(channels_of(recording_from(new_array({specific_force.shape(0)}),
                                                   specific_force, turn, position, orientation)));
      },
      py::arg("specific_force"), py::arg("angular_velocity") = py::none(),
      py::arg("position") = py::none(), py::arg("orientation") = py::none(),
      R"doc(Returns which channels of CHANNEL_NAMES a recording of T samples has.

A gyroscope that reads nothing but zeros does not count: devices without one may send them.)doc");
  m.def("gravity_directions", &directions, py::arg("times_s"), py::arg("specific_force"),
        py::arg("angular_velocity"), py::kw_only(), py::arg("average") = "causal",
        R"doc(Returns unit vectors against gravity, upwards, in a sensor's axes, (T, 3).

specific_force (T, 3) m/s^2 and angular_velocity (T, 3) rad/s are in the sensor's axes; average
is a gravity_average of ReadingStream. NaN in the first half second of the causal average, and
everywhere when the gyroscope reads nothing but zeros. Inclination as in VQF (Laidig and Seel,
Information Fusion 91, 2023).)doc");
}

void bind_times(py::module_& m) {
  m.def(
      "spread_evenly",
      [](const Doubles& arrival_s) {
        require_shape(arrival_s, {-1}, "arrival_s");
        return array_of(spread_evenly(span_of(arrival_s)));
      },
      py::arg("arrival_s"), R"doc(Returns ascending times (T,) of samples by their arrivals (T,), s.

Samples that arrived at once are spread over the time before.)doc");
  m.def(
      "host_times",
      [](const Doubles& device_s, const Doubles& arrival_s) {
        require_shape(device_s, {-1}, "device_s");
        require_shape(arrival_s, {device_s.shape(0)}, "arrival_s");
        const HostTimes found = host_times(span_of(device_s), span_of(arrival_s));
        return py::make_tuple(array_of(found.times_s), found.rate);
      },
      py::arg("device_s"), py::arg("arrival_s"),
      R"doc(Returns when samples were taken, (T,) s on the host's clock, and its rate.

The rate is host seconds per device second. device_s (T,) is unwrapped, or NaN for a device
without a clock; then the arrivals are spread evenly. A rate further from 1 than
LARGEST_CLOCK_DRIFT, such as that of an emulator that plays faster, is returned, but the times
keep the device's seconds. Raises ValueError when sizes differ.)doc");
}

}  // namespace

void bind_readings(py::module_& m) {
  m.attr("LARGEST_CLOCK_DRIFT") = kLargestClockDrift;
  bind_reading_values(m);
  bind_sensor_input(m);
  bind_stream(m);
  bind_recording_functions(m);
  bind_times(m);
}

}  // namespace sparse_mocap::python
