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
  py::class_<ClockModel>(
      m, "ClockModel",
      R"doc(Maps a device's clock to the host's monotonic clock; samples arrive late, never early.

A delay that all samples share cannot be measured and stays in the offset.)doc")
      .def(py::init([](double largest_drift_ppm, double window_s) {
             return ClockModel({1e-6 * largest_drift_ppm, window_s, 1.0});
           }),
           py::kw_only(), py::arg("largest_drift_ppm") = 500.0, py::arg("window_s") = 600.0,
           "Estimates a drift of at most largest_drift_ppm from the arrivals of the last window_s.")
      .def("observe", &ClockModel::observe, py::arg("device_s"), py::arg("arrival_s"),
           R"doc(Returns the host time of a sample or burst, s; never before the one returned last.

device_s is the device's unwrapped time, arrival_s the host's when it was received. Raises
ValueError for times that are not finite.)doc")
      .def("host_time_s", &ClockModel::host_time_s, py::arg("device_s"),
           "Returns the host time of a device time, s, as estimated from all arrivals so far.")
      .def_property_readonly("offset_s", &ClockModel::offset_s,
                             "Host time at which the device's time is 0, s.")
      .def_property_readonly(
          "drift_ppm", &ClockModel::drift_ppm,
          "How slow the device's clock is, in parts per million; negative when it is fast.")
      .def_property_readonly(
          "mean_lateness_s", &ClockModel::mean_lateness_s,
          "How much later than estimated the arrivals of the window are on average, s.")
      .def_property_readonly(
          "num_segments", &ClockModel::num_segments,
          "1 from the first sample on, and 1 more for each reset of the device's clock.");
  m.def("align_in_time", &align, py::arg("first_times_s"), py::arg("first"),
        py::arg("second_times_s"), py::arg("second"), py::kw_only(), py::arg("largest_lag_s") = 1.0,
        py::arg("window_s") = 1.5,
        R"doc(Returns the lag between the clocks of two sensors, from an event that both recorded.

first and second are magnitudes, such as that of specific force, one for each of the ascending
times. They are correlated in a window around the strongest common event, a clap or a jump.

``lag_s``: subtract it from the second sensor's times; ``correlation``: at this lag, -1 to 1;
``runner_up``: the best correlation at another lag; ``event_s``: the middle of the event on the
first clock; ``is_found``: True when the event is clear and only one lag fits it.

Raises ValueError when sizes differ or the recordings overlap by less than the window.)doc");
}

}  // namespace sparse_mocap::python
