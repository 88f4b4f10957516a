// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/sensors/filter.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap::python {
namespace {

std::vector<double> sample_times(const Motion& motion, double rate_hz) {
  const double last_s = motion.frame_time_s * (motion.num_frames() - 1);
  std::vector<double> times;
  for (int t = 0; t / rate_hz <= last_s + 1e-9; ++t) times.push_back(t / rate_hz);
  return times;
}

// Samples between the motion's frames, without further filtering.
Eigen::MatrixXd sampled(const Eigen::MatrixXd& values, const Motion& motion,
                        const std::vector<double>& wanted_s) {
  std::vector<double> times;
  for (int t = 0; t < motion.num_frames(); ++t) times.push_back(t * motion.frame_time_s);
  return filtered_at(times, values, wanted_s, GaussianFilter{0.0});
}

void copy_orientation(const std::vector<Mat3>& R_world_sensor, const Motion& motion,
                      const std::vector<double>& wanted_s, double* out) {
  const auto last = R_world_sensor.size() - 1;
  for (const double at_s : wanted_s) {
    const double position = at_s / motion.frame_time_s;
    const auto frame = std::min(static_cast<std::size_t>(position), last);
    const Quat q = Quat(R_world_sensor[frame])
                       .slerp(std::min(position - static_cast<double>(frame), 1.0),
                              Quat(R_world_sensor[std::min(frame + 1, last)]));
    const Eigen::Vector4d wxyz = wxyz_of(q);
    out = std::copy(wxyz.begin(), wxyz.end(), out);
  }
}

py::dict simulate(const Motion& motion, const std::vector<std::string>& site_names, double rate_hz,
                  const std::optional<std::vector<double>>& positions_along_bone) {
  if (!(rate_hz > 0.0)) throw py::value_error("rate_hz must be positive");
  if (motion.num_frames() < 3) throw py::value_error("the motion has fewer than 3 frames");
  if (positions_along_bone && positions_along_bone->size() != site_names.size())
    throw py::value_error("positions_along_bone must have one entry a site");
  const auto positions = positions_along_bone.value_or(std::vector<double>(site_names.size(), 1.0));
  std::vector<Site> sites;
  for (const auto& name : site_names)
    sites.push_back(all_sites()[static_cast<std::size_t>(find_site(name))]);
  std::vector<VirtualReadings> readings;
  {
    const py::gil_scoped_release release;
    readings = virtual_readings(motion, sites);
  }
  const auto times = sample_times(motion, rate_hz);
  const auto n = static_cast<py::ssize_t>(times.size());
  const auto s = static_cast<py::ssize_t>(sites.size());
  py::array_t<double> time_s(n);
  std::copy(times.begin(), times.end(), time_s.mutable_data());
  auto force = new_array({s, n, 3}), turn = new_array({s, n, 3}), position = new_array({s, n, 3}),
       orientation = new_array({s, n, 4});
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const auto at = static_cast<py::ssize_t>(i);
    const Eigen::MatrixXd f = sampled(readings[i].specific_force(positions[i]), motion, times);
    const Eigen::MatrixXd w = sampled(readings[i].angular_velocity, motion, times);
    const Eigen::MatrixXd p = sampled(readings[i].position(positions[i]), motion, times);
    std::copy(f.data(), f.data() + f.size(), force.mutable_data(at, 0, 0));
    std::copy(w.data(), w.data() + w.size(), turn.mutable_data(at, 0, 0));
    std::copy(p.data(), p.data() + p.size(), position.mutable_data(at, 0, 0));
    copy_orientation(readings[i].R_world_sensor, motion, times, orientation.mutable_data(at, 0, 0));
  }
  py::dict out;
  out["time_s"] = time_s;
  out["specific_force"] = force;
  out["angular_velocity"] = turn;
  out["position"] = position;
  out["orientation"] = orientation;
  return out;
}

py::array_t<double> filtered(const Doubles& times_s, const Doubles& values,
                             const Doubles& wanted_s) {
  require_shape(times_s, {-1}, "times_s");
  require_shape(values, {times_s.shape(0), -1}, "values");
  require_shape(wanted_s, {-1}, "wanted_s");
  if (times_s.shape(0) == 0) throw py::value_error("times_s is empty");
  const Eigen::MatrixXd result =
      filtered_at(span_of(times_s), columns_of(values), span_of(wanted_s), kReadingFilter);
  return rows_of(result);
}

}  // namespace

void bind_sensors(py::module_& m) {
  m.attr("FILTER_REACH_S") = kReadingFilter.reach_s();
  m.def(
      "site_names",
      [] {
        std::vector<std::string> names;
        for (const auto& site : all_sites()) names.emplace_back(site.name);
        return names;
      },
      "Returns all sensor locations, such as left_wrist, in the order of a database's arrays.");
  m.def("simulate", &simulate, py::arg("motion"), py::arg("sites"), py::arg("rate_hz"),
        py::arg("positions_along_bone") = py::none(),
        R"doc(Returns what ideal sensors read during a motion of the standard skeleton.

``time_s`` (T,); ``specific_force`` (S, T, 3) m/s^2 and ``angular_velocity`` (S, T, 3) rad/s,
both in the sensor's axes; ``position`` (S, T, 3) m, world; ``orientation`` (S, T, 4)
R_world_sensor, w x y z. See Tautges et al. 2011, section 3.

positions_along_bone has a number for each site, from 0 at the joint near the body to 1, the
default, at the bone's far end. Raises ConfigError for an unknown site, and ValueError for a
motion of fewer than 3 frames, a rate that is not positive or another number of positions.)doc");
  m.def(
      "filtered_at", &filtered, py::arg("times_s"), py::arg("values"), py::arg("wanted_s"),
      R"doc(Returns values (T, C) at times (T,) low-passed and sampled at wanted_s (N,), as (N, C).

The filter is the Gaussian one, -3 dB at 11.5 Hz, that a database's readings passed; times_s
ascend, evenly or not. Raises ValueError when they are empty.)doc");
}

}  // namespace sparse_mocap::python
