// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "readings.hpp"
#include "sparse_mocap/readings/channel_names.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {
namespace {

// A channel of all readings, (T, S, 3 or 4).
template <typename Matrix>
py::array_t<double> stacked(const Readings& all, Matrix Reading::*channel) {
  constexpr py::ssize_t kRows = Matrix::RowsAtCompileTime;
  const auto num_sensors = static_cast<py::ssize_t>(all.sensors.size());
  auto out = new_array({static_cast<py::ssize_t>(all.readings.size()), num_sensors, kRows});
  double* next = out.mutable_data();
  for (const Reading& reading : all.readings) {
    const Matrix& values = reading.*channel;
    next = std::copy(values.data(), values.data() + values.size(), next);
  }
  return out;
}

py::array_t<double> times_of(const Readings& all) {
  std::vector<double> times_s;
  for (const Reading& reading : all.readings) times_s.push_back(reading.time_s);
  return array_of(times_s);
}

template <typename Matrix>
void set_channel(Readings& all, const std::optional<Doubles>& values, Matrix Reading::*channel,
                 Channel kind) {
  if (!values) return;
  constexpr py::ssize_t kRows = Matrix::RowsAtCompileTime;
  const auto num_sensors = static_cast<py::ssize_t>(all.sensors.size());
  require_shape(*values, {static_cast<py::ssize_t>(all.readings.size()), num_sensors, kRows},
                std::string(name_of(kind)).c_str());
  for (std::size_t t = 0; t < all.readings.size(); ++t)
    all.readings[t].*channel = Eigen::Map<const Matrix>(
        values->data(static_cast<py::ssize_t>(t), 0, 0), kRows, num_sensors);
  for (std::size_t s = 0; s < all.sensors.size(); ++s) {
    bool is_there = false;
    for (const Reading& reading : all.readings)
      is_there |= (reading.*channel).col(static_cast<Eigen::Index>(s)).allFinite();
    if (is_there) all.sensors[s].channels = all.sensors[s].channels | kind;
  }
}

Readings readings_from(const std::vector<std::string>& sites, const Doubles& times_s,
                       const std::optional<Doubles>& specific_force,
                       const std::optional<Doubles>& angular_velocity,
                       const std::optional<Doubles>& gravity_direction,
                       const std::optional<Doubles>& position,
                       const std::optional<Doubles>& orientation,
                       const std::optional<std::vector<double>>& positions_along_bone) {
  require_shape(times_s, {-1}, "times_s");
  if (positions_along_bone && positions_along_bone->size() != sites.size())
    throw py::value_error("positions_along_bone must have one entry a site");
  Readings all;
  for (std::size_t s = 0; s < sites.size(); ++s)
    all.sensors.push_back(
        {find_site(sites[s]), positions_along_bone ? (*positions_along_bone)[s] : 1.0, Channels()});
  for (const double time_s : span_of(times_s)) {
    all.readings.emplace_back(static_cast<Eigen::Index>(sites.size()));
    all.readings.back().time_s = time_s;
  }
  set_channel(all, specific_force, &Reading::specific_force, Channel::specific_force);
  set_channel(all, angular_velocity, &Reading::angular_velocity, Channel::angular_velocity);
  set_channel(all, gravity_direction, &Reading::gravity_direction, Channel::gravity_direction);
  set_channel(all, position, &Reading::position, Channel::position);
  set_channel(all, orientation, &Reading::orientation, Channel::orientation);
  return all;
}

Readings at(const Readings& all, py::ssize_t index) {
  const auto count = static_cast<py::ssize_t>(all.readings.size());
  if (index < 0) index += count;
  if (index < 0 || index >= count) throw py::index_error("no such reading");
  return {all.sensors, {all.readings[static_cast<std::size_t>(index)]}};
}

Readings sliced(const Readings& all, const py::slice& slice) {
  std::size_t start = 0, stop = 0, step = 0, length = 0;
  if (!slice.compute(all.readings.size(), &start, &stop, &step, &length))
    throw py::error_already_set();
  Readings out{all.sensors, {}};
  for (std::size_t i = 0; i < length; ++i, start += step)
    out.readings.push_back(all.readings[start]);
  return out;
}

Eigen::MatrixXd absent(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::Constant(rows, columns, std::nan(""));
}

using ReadingsClass = py::class_<Readings>;

void bind_values(ReadingsClass& readings) {
  readings.def_property_readonly("times_s", &times_of, "(T,) s, ascending.")
      .def_property_readonly(
          "specific_force",
          [](const Readings& all) { return stacked(all, &Reading::specific_force); },
          "(T, S, 3) m/s^2, gravity included: 9.81 upwards at rest.")
      .def_property_readonly(
          "angular_velocity",
          [](const Readings& all) { return stacked(all, &Reading::angular_velocity); },
          "(T, S, 3) rad/s.")
      .def_property_readonly(
          "gravity_direction",
          [](const Readings& all) { return stacked(all, &Reading::gravity_direction); },
          "(T, S, 3) unit vectors against gravity, upwards.")
      .def_property_readonly(
          "position", [](const Readings& all) { return stacked(all, &Reading::position); },
          "(T, S, 3) m, world.")
      .def_property_readonly(
          "orientation", [](const Readings& all) { return stacked(all, &Reading::orientation); },
          "(T, S, 4) R_world_sensor, w x y z.");
}

void bind_sensors_of(ReadingsClass& readings) {
  readings
      .def_property_readonly(
          "sites",
          [](const Readings& all) {
            std::vector<std::string> names;
            for (const Sensor& sensor : all.sensors)
              names.emplace_back(all_sites()[static_cast<std::size_t>(sensor.site)].name);
            return names;
          },
          "The S sensor locations.")
      .def_property_readonly(
          "positions_along_bone",
          [](const Readings& all) {
            std::vector<double> positions;
            for (const Sensor& sensor : all.sensors)
              positions.push_back(sensor.position_along_bone);
            return positions;
          },
          "S positions, from 0 at the joint near the body to 1 at the bone's far end.")
      .def_property_readonly(
          "channels",
          [](const Readings& all) {
            std::vector<std::vector<std::string_view>> channels;
            for (const Sensor& sensor : all.sensors) channels.push_back(names_of(sensor.channels));
            return channels;
          },
          "The names of each sensor's channels, of CHANNEL_NAMES.");
}

}  // namespace

Channels channels_from(const std::vector<std::string>& names) {
  Channels channels;
  for (const auto& name : names) channels = channels | find_channel(name);
  return channels;
}

SensorRecording recording_from(const Doubles& times_s, const std::optional<Doubles>& specific_force,
                               const std::optional<Doubles>& angular_velocity,
                               const std::optional<Doubles>& position,
                               const std::optional<Doubles>& orientation) {
  require_shape(times_s, {-1}, "times_s");
  const auto count = times_s.shape(0);
  const auto columns = [count](const std::optional<Doubles>& rows, py::ssize_t width,
                               const char* name) -> Eigen::MatrixXd {
    if (!rows) return absent(width, 0);
    require_shape(*rows, {count, width}, name);
    return columns_of(*rows);
  };
  SensorRecording out;
  const auto seconds = span_of(times_s);
  out.times_s.assign(seconds.begin(), seconds.end());
  out.specific_force = columns(specific_force, 3, "specific_force");
  if (!specific_force) out.specific_force = absent(3, count);
  out.angular_velocity = columns(angular_velocity, 3, "angular_velocity");
  out.position = columns(position, 3, "position");
  out.orientation = columns(orientation, 4, "orientation");
  return out;
}

void bind_reading_values(py::module_& m) {
  m.attr("CHANNEL_NAMES") = [] {
    py::tuple names(all_channels().size());
    for (std::size_t i = 0; i < names.size(); ++i)
      names[i] = py::str(std::string(name_of(all_channels()[i])));
    return names;
  }();
  ReadingsClass readings(
      m, "Readings",
      R"doc(The values of S sensors at T times, in each sensor's axes unless said otherwise.

An index or a slice selects times; len() is T.)doc");
  readings
      .def(py::init(&readings_from), py::arg("sites"), py::arg("times_s"), py::kw_only(),
           py::arg("specific_force") = py::none(), py::arg("angular_velocity") = py::none(),
           py::arg("gravity_direction") = py::none(), py::arg("position") = py::none(),
           py::arg("orientation") = py::none(), py::arg("positions_along_bone") = py::none(),
           R"doc(Takes arrays shaped like the properties below; a channel that is not given is NaN.

A sensor has those channels that are finite at some time; positions_along_bone are 1 by
default. Raises ConfigError for an unknown site and ValueError for other shapes.)doc")
      .def("__len__", [](const Readings& all) { return all.readings.size(); })
      .def("__getitem__", &at, py::arg("index"))
      .def("__getitem__", &sliced, py::arg("index"));
  bind_values(readings);
  bind_sensors_of(readings);
}

}  // namespace sparse_mocap::python
