// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/sensors/clock.hpp"
#include "sparse_mocap/sensors/time_alignment.hpp"

namespace sparse_mocap::python {
namespace {

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
  m.def("align_in_time", &align, py::arg("first_times_s"), py::arg("first"),
        py::arg("second_times_s"), py::arg("second"), py::kw_only(), py::arg("largest_lag_s") = 1.0,
        py::arg("window_s") = 1.5);
}

}  // namespace sparse_mocap::python
