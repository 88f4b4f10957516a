// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <tuple>

#include "common.hpp"
#include "methods.hpp"
#include "readings.hpp"
#include "sparse_mocap/methods/reconstruct.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::python {
namespace {

// One estimate and the skeleton that its rotations belong to.
struct BoundEstimate {
  PoseEstimate estimate;
  std::shared_ptr<const Skeleton> skeleton;
};

py::array_t<double> rotations_of(const PoseEstimate& estimate) {
  auto out = new_array({static_cast<py::ssize_t>(estimate.rotations.size()), 4});
  double* value = out.mutable_data();
  for (const Quat& q : estimate.rotations)
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) *value++ = v;
  return out;
}

py::array_t<double> heading_positions(const BoundEstimate& bound) {
  const Motion motion = to_motion({bound.estimate}, *bound.skeleton, 1.0);
  const Eigen::MatrixXd column = joint_positions(motion, PositionFrame::heading);
  auto out = new_array({column.rows() / 3, 3});
  std::copy(column.data(), column.data() + column.size(), out.mutable_data());
  return out;
}

py::array_t<double> vector_of(const Eigen::VectorXd& values) {
  auto out = new_array({values.size()});
  std::copy(values.data(), values.data() + values.size(), out.mutable_data());
  return out;
}

py::dict diagnostics_of(const PoseEstimate& estimate) {
  py::dict out;
  for (const auto& [name, values] : estimate.diagnostics) out[name.c_str()] = vector_of(values);
  return out;
}

// Of the whole take: name to (T, N), what a frame lacks being NaN.
py::dict stacked_diagnostics(const Reconstruction& solved) {
  std::map<std::string, Eigen::Index> widths;
  for (const auto& estimate : solved.estimates)
    for (const auto& [name, values] : estimate.diagnostics)
      widths[name] = std::max(widths[name], values.size());
  py::dict out;
  for (const auto& [name, width] : widths) {
    auto rows = new_array({static_cast<py::ssize_t>(solved.estimates.size()), width});
    std::fill(rows.mutable_data(), rows.mutable_data() + rows.size(), std::nan(""));
    double* row = rows.mutable_data();
    for (const auto& estimate : solved.estimates) {
      const auto found = estimate.diagnostics.find(name);
      if (found != estimate.diagnostics.end())
        std::copy(found->second.data(), found->second.data() + found->second.size(), row);
      row += width;
    }
    out[name.c_str()] = rows;
  }
  return out;
}

std::vector<BoundEstimate> bound(std::vector<PoseEstimate> estimates,
                                 const std::shared_ptr<const Skeleton>& skeleton) {
  std::vector<BoundEstimate> out;
  for (auto& estimate : estimates) out.push_back({std::move(estimate), skeleton});
  return out;
}

// The live reconstructor with its skeleton in a place of its own, so that estimates outlive it.
class BoundLive {
 public:
  BoundLive(const std::vector<SensorInput>& sensors, const ReconstructionRequest& request,
            int largest_backlog)
      : live_(sensors, request, largest_backlog),
        skeleton_(std::make_shared<const Skeleton>(live_.skeleton())) {}

  LiveReconstructor& live() { return live_; }
  std::vector<BoundEstimate> advance(double now_s) {
    return bound(live_.advance(now_s), skeleton_);
  }
  std::vector<BoundEstimate> flush() { return bound(live_.flush(), skeleton_); }
  const Skeleton& skeleton() const { return *skeleton_; }

 private:
  LiveReconstructor live_;
  std::shared_ptr<const Skeleton> skeleton_;
};

py::array_t<double> contacts_of(const Reconstruction& solved) {
  auto out = new_array({static_cast<py::ssize_t>(solved.estimates.size()), 2});
  double* value = out.mutable_data();
  for (const auto& estimate : solved.estimates)
    value = std::copy(estimate.contacts.data(), estimate.contacts.data() + 2, value);
  return out;
}

std::vector<std::tuple<double, double, double>> differences_of(const Reconstruction& solved) {
  std::vector<std::tuple<double, double, double>> out;
  for (const auto& part : solved.differences)
    out.emplace_back(part.begin_s, part.end_s, part.distance_m);
  return out;
}

void bind_recording(py::module_& m) {
  py::class_<SensorRecording>(m, "SensorRecording", "T samples of one sensor.")
      .def(py::init(&recording_from), py::arg("times_s"), py::arg("specific_force") = py::none(),
           py::arg("angular_velocity") = py::none(), py::arg("position") = py::none(),
           py::arg("orientation") = py::none(),
           R"doc(times_s (T,) ascend and are on the clock that all sensors share.

specific_force (T, 3), in m/s^2 once calibrated, and angular_velocity (T, 3) rad/s are in
the sensor's axes; position (T, 3) m and orientation (T, 4) R_world_sensor, w x y z, in the
tracker's world. None and NaN: not measured. Raises ValueError for other shapes.)doc");
}

void bind_estimate(py::module_& m) {
  py::class_<BoundEstimate>(m, "PoseEstimate", "One reconstructed frame.")
      .def_property_readonly(
          "time_s", [](const BoundEstimate& b) { return b.estimate.time_s; },
          "When the sensors measured it, in s on the clock of the samples.")
      .def_property_readonly(
          "rotations", [](const BoundEstimate& b) { return rotations_of(b.estimate); },
          "(J, 4) w x y z: each joint relative to its parent, the root in the world.")
      .def_property_readonly(
          "root_position",
          [](const BoundEstimate& b) { return vector_of(b.estimate.root_position); },
          "(3,) m, world, pivot of the root.")
      .def_property_readonly("positions", &heading_positions,
                             "(J, 3) m, the joints' ends in the heading frame.")
      .def_property_readonly(
          "contacts", [](const BoundEstimate& b) { return vector_of(b.estimate.contacts); },
          "(2,) probability that the left and the right foot are on the ground.")
      .def_property_readonly(
          "diagnostics", [](const BoundEstimate& b) { return diagnostics_of(b.estimate); },
          "Further results of the method: name to array, units in the names.");
}

void bind_result(py::module_& m) {
  py::class_<Reconstruction>(m, "Reconstruction", "A reconstructed take: T frames, J joints.")
      .def_property_readonly("motion", &Reconstruction::motion,
                             "The motion in the world, on the method's skeleton.")
      .def_property_readonly(
          "readings",
          [](const Reconstruction& r) {
            return Readings{r.sensors, r.readings};
          },
          "The T readings that the method used.")
      .def_readonly("rate_hz", &Reconstruction::rate_hz, "Frames a second.")
      .def_readonly("latency_s", &Reconstruction::latency_s,
                    "How long after its reading a live pose is ready, in s; None for best quality.")
      .def_readonly("notes", &Reconstruction::notes,
                    "What the method says of the take, a line each.")
      .def_readonly(
          "alternatives", &Reconstruction::alternatives,
          R"doc(What else the take may have been, the likeliest first, each a whole result.

In best quality, where the method has an option of that name and it is set.)doc")
      .def_property_readonly("differences", &differences_of,
                             R"doc(Where an alternative differs from the result that has it.

(begin, end, distance): s from the take's beginning, and how far the joints are apart, m, mean over
the joints and the part, heading frame. Empty for the first result.)doc")
      .def_property_readonly(
          "contacts", &contacts_of,
          "(T, 2) probability that the left and the right foot are on the ground.")
      .def_property_readonly(
          "diagnostics", &stacked_diagnostics,
          "Further results of the method: name to (T, N), units in the names; NaN where absent.");
}

void bind_live(py::module_& m) {
  py::class_<BoundLive>(m, "LiveReconstructor",
                        "Turns sensors' samples into poses as they arrive; use it from one thread.")
      .def(py::init([](const std::vector<SensorInput>& sensors,
                       const ReconstructionRequest& request, int largest_backlog) {
             const py::gil_scoped_release release;
             return std::make_unique<BoundLive>(sensors, request, largest_backlog);
           }),
           py::arg("sensors"), py::arg("request"), py::kw_only(), py::arg("largest_backlog") = 0,
           R"doc(largest_backlog: when more readings wait, all but the newest are skipped; 0: never.

After a skip the method starts again without a past. Raises ConfigError for what the method
cannot use.)doc")
      .def_property_readonly(
          "readings", [](BoundLive& b) -> ReadingStream& { return b.live().readings(); },
          py::return_value_policy::reference_internal,
          "The stream to push the sensors' samples into.")
      .def("advance", &BoundLive::advance, py::arg("now_s"),
           py::call_guard<py::gil_scoped_release>(),
           "Returns the next poses that are ready at now_s, on the clock of the samples.")
      .def("flush", &BoundLive::flush, py::call_guard<py::gil_scoped_release>(),
           "Returns the remaining poses when the performance has ended.")
      .def_property_readonly("skeleton", &BoundLive::skeleton, "The skeleton of the poses.")
      .def_property_readonly(
          "rate_hz", [](BoundLive& b) { return b.live().rate_hz(); }, "Poses a second.")
      .def_property_readonly(
          "latency_s", [](BoundLive& b) { return b.live().latency_s(); },
          "How long after its reading a pose is ready, in s.")
      .def_property_readonly(
          "history_s", [](BoundLive& b) { return b.live().history_s(); },
          "How far back the readings reach that a pose depends on, in s.")
      .def_property_readonly(
          "last_reading_s", [](BoundLive& b) { return b.live().last_reading_s(); },
          "When the last reading was that any sensor was in, in s; -inf before there is one.")
      .def_property_readonly(
          "notes", [](BoundLive& b) { return b.live().notes(); },
          "What the method says of the performance so far, a line each.")
      .def_property_readonly(
          "num_skipped", [](BoundLive& b) { return b.live().num_skipped(); },
          "How many readings were skipped because they came faster than poses could be computed.");
}

Reconstruction reconstruct_take(const std::vector<SensorRecording>& take,
                                const std::vector<SensorInput>& sensors,
                                const ReconstructionRequest& request, bool best_quality,
                                const std::optional<py::function>& callback) {
  const Progress progress = progress_from(callback);
  const py::gil_scoped_release release;
  return reconstruct(take, sensors, request, best_quality ? Quality::best : Quality::live,
                     progress);
}

}  // namespace

void bind_reconstruction(py::module_& m) {
  bind_methods(m);
  bind_recording(m);
  bind_estimate(m);
  bind_result(m);
  bind_live(m);
  m.def("reconstruct", &reconstruct_take, py::arg("take"), py::arg("sensors"), py::arg("request"),
        py::kw_only(), py::arg("best_quality") = false, py::arg("progress") = py::none(),
        R"doc(Returns the motion of a whole take: a recording and an input for each sensor.

best_quality uses the whole take for each pose; otherwise poses are those of a live preview.
Raises ConfigError for what the method cannot use, Cancelled, and ValueError unless there are
as many recordings as sensors.)doc");
}

}  // namespace sparse_mocap::python
