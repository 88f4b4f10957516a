// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/sensors/sensor_recording.hpp"

namespace sparse_mocap::python {

// What sensors read at successive times.
struct Readings {
  std::vector<Sensor> sensors;
  std::vector<Reading> readings;
};

void bind_reading_values(py::module_& m);

Channels channels_from(const std::vector<std::string>& names);

// Arrays (T,), (T, 3) and (T, 4) of one sensor; None where it lacks the channel.
SensorRecording recording_from(const Doubles& times_s, const std::optional<Doubles>& specific_force,
                               const std::optional<Doubles>& angular_velocity,
                               const std::optional<Doubles>& position,
                               const std::optional<Doubles>& orientation);

}  // namespace sparse_mocap::python
