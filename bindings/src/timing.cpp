// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/sensors/clock.hpp"
#include "sparse_mocap/sensors/inclination.hpp"
#include "sparse_mocap/sensors/resampler.hpp"
#include "sparse_mocap/sensors/time_alignment.hpp"

namespace sparse_mocap::python {
namespace {

std::span<const double> span_of(const Doubles& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

py::dict align(const Doubles& first_times, const Doubles& first, const Doubles& second_times,
               const Doubles& second, double largest_lag_s, double window_s) {
  require_shape(first_times, {-1}, "first_times_s");
  require_shape(first, {first_times.shape(0)}, "first");
  require_shape(second_times, {-1}, "second_times_s");
  require_shape(second, {second_times.shape(0)}, "second");
  const TimeLag lag = align_in_time(span_of(first_times), span_of(first), span_of(second_times),
                                    span_of(second), {largest_lag_s, window_s});
  py::dict out;
  out["lag_s"] = lag.lag_s;
  out["correlation"] = lag.correlation;
  out["runner_up"] = lag.runner_up;
  out["event_s"] = lag.event_s;
  out["is_found"] = lag.is_found();
  return out;
}

py::array_t<double> rows_of(const Eigen::Matrix3Xd& columns) {
  auto rows = new_array({columns.cols(), 3});
  std::copy(columns.data(), columns.data() + columns.size(), rows.mutable_data());
  return rows;
}

// (time_s, (S, 3)) for each frame.
py::list told(const std::vector<ResampledFrame>& frames) {
  py::list out;
  for (const auto& frame : frames) {
    out.append(py::make_tuple(frame.time_s, rows_of(frame.specific_force)));
  }
  return out;
}

py::array_t<double> whole_inclinations(const Doubles& times, const Doubles& force,
                                       const Doubles& rate, bool offline) {
  require_shape(times, {-1}, "times_s");
  require_shape(force, {times.shape(0), 3}, "specific_force");
  require_shape(rate, {times.shape(0), 3}, "angular_velocity");
  const auto columns = [](const Doubles& rows) {
    return Eigen::Map<const Eigen::Matrix3Xd>(rows.data(), 3, rows.shape(0));
  };
  const auto seconds = span_of(times);
  const SensorRecording recording{{seconds.begin(), seconds.end()}, columns(force), columns(rate)};
  const py::gil_scoped_release release;
  const Eigen::Matrix3Xd up =
      offline ? inclinations_offline(recording) : inclinations_online(recording);
  const py::gil_scoped_acquire acquire;
  return rows_of(up);
}

void bind_inclination(py::module_& m) {
  py::class_<InclinationFilter>(m, "InclinationFilter")
      .def(py::init<>())
      .def(
          "update",
          [](InclinationFilter& filter, double time_s, const Doubles& force, const Doubles& rate) {
            require_shape(force, {3}, "specific_force");
            require_shape(rate, {3}, "angular_velocity");
            const Vec3 up = filter.update(time_s, Vec3(force.data()), Vec3(rate.data()));
            auto out = new_array({3});
            std::copy(up.data(), up.data() + 3, out.mutable_data());
            return out;
          },
          py::arg("time_s"), py::arg("specific_force"), py::arg("angular_velocity"));
  m.def("inclinations", &whole_inclinations, py::arg("times_s"), py::arg("specific_force"),
        py::arg("angular_velocity"), py::kw_only(), py::arg("offline") = false);
}

}  // namespace

void bind_timing(py::module_& m) {
  py::class_<ClockModel>(m, "ClockModel")
      .def(py::init([](double largest_drift_ppm, double window_s) {
             return ClockModel({1e-6 * largest_drift_ppm, window_s, 1.0});
           }),
           py::kw_only(), py::arg("largest_drift_ppm") = 500.0, py::arg("window_s") = 600.0)
      .def("observe", &ClockModel::observe, py::arg("device_s"), py::arg("arrival_s"))
      .def("host_time_s", &ClockModel::host_time_s, py::arg("device_s"))
      .def_property_readonly("offset_s", &ClockModel::offset_s)
      .def_property_readonly("drift_ppm", &ClockModel::drift_ppm)
      .def_property_readonly("mean_lateness_s", &ClockModel::mean_lateness_s)
      .def_property_readonly("num_segments", &ClockModel::num_segments);
  py::class_<Resampler>(m, "Resampler")
      .def(py::init<int, double>(), py::arg("num_sensors"), py::arg("rate_hz"))
      .def(
          "push",
          [](Resampler& resampler, int sensor, double time_s, const Doubles& force) {
            require_shape(force, {3}, "specific_force");
            return resampler.push(sensor, time_s, Vec3(force.data()));
          },
          py::arg("sensor"), py::arg("time_s"), py::arg("specific_force"))
      .def(
          "frames_until",
          [](Resampler& resampler, double now_s) { return told(resampler.frames_until(now_s)); },
          py::arg("now_s"))
      .def("flush", [](Resampler& resampler) { return told(resampler.flush()); })
      .def_property_readonly("delay_s", &Resampler::delay_s);
  bind_inclination(m);
  m.def("align_in_time", &align, py::arg("first_times_s"), py::arg("first"),
        py::arg("second_times_s"), py::arg("second"), py::kw_only(), py::arg("largest_lag_s") = 1.0,
        py::arg("window_s") = 1.5);
}

}  // namespace sparse_mocap::python
