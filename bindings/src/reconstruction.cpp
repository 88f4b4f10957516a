// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

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
  std::vector<BoundEstimate> advance(double now_s) { return bound(live_.advance(now_s), skeleton_); }
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

void bind_values(py::module_& m) {
  py::class_<SensorRecording>(m, "SensorRecording", "What one sensor measured in a performance.")
      .def(py::init(&recording_from), py::arg("times_s"), py::arg("specific_force") = py::none(),
           py::arg("angular_velocity") = py::none(), py::arg("position") = py::none(),
           py::arg("orientation") = py::none());
  py::class_<BoundEstimate>(m, "PoseEstimate", "One reconstructed frame.")
      .def_property_readonly(
          "time_s", [](const BoundEstimate& b) { return b.estimate.time_s; },
          "When the sensors read it, s.")
      .def_property_readonly(
          "rotations", [](const BoundEstimate& b) { return rotations_of(b.estimate); },
          "(J, 4) w x y z: each joint relative to its parent, the root in the world.")
      .def_property_readonly(
          "root_position",
          [](const BoundEstimate& b) { return vector_of(b.estimate.root_position); },
          "(3,) m, world.")
      .def_property_readonly("positions", &heading_positions,
                             "(J, 3) m: the joints in the heading frame.")
      .def_property_readonly(
          "contacts", [](const BoundEstimate& b) { return vector_of(b.estimate.contacts); },
          "(2,) probability that the left and the right foot stand.")
      .def_property_readonly(
          "diagnostics", [](const BoundEstimate& b) { return diagnostics_of(b.estimate); },
          "What the method says of the frame: name to array, units in the names.");

  py::class_<Reconstruction>(m, "Reconstruction", "A reconstructed take: T frames, J joints.")
      .def_property_readonly("motion", &Reconstruction::motion,
                             "The motion in the world, on the method's skeleton.")
      .def_property_readonly(
          "readings",
          [](const Reconstruction& r) { return Readings{r.sensors, r.readings}; },
          "What the method was given, at its rate.")
      .def_readonly("rate_hz", &Reconstruction::rate_hz, "Frames a second.")
      .def_readonly("latency_s", &Reconstruction::latency_s,
                    "How long after its reading a live pose is ready, s; None for best quality.")
      .def_property_readonly("contacts", &contacts_of,
                             "(T, 2) probability that the left and the right foot stand.")
      .def_property_readonly("diagnostics", &stacked_diagnostics,
                             "What the method says of each frame: name to (T, N), units in the "
                             "names.");
}

void bind_live(py::module_& m) {
  py::class_<BoundLive>(m, "LiveReconstructor",
                        "Sensors' samples to poses as they come; use it from one thread.")
      .def(py::init([](const std::vector<SensorInput>& sensors,
                       const ReconstructionRequest& request, int largest_backlog) {
             const py::gil_scoped_release release;
             return std::make_unique<BoundLive>(sensors, request, largest_backlog);
           }),
           py::arg("sensors"), py::arg("request"), py::kw_only(), py::arg("largest_backlog") = 0)
      .def_property_readonly(
          "readings", [](BoundLive& b) -> ReadingStream& { return b.live().readings(); },
          py::return_value_policy::reference_internal,
          "The stream that takes the sensors' samples.")
      .def("advance", &BoundLive::advance, py::arg("now_s"),
           py::call_guard<py::gil_scoped_release>(),
           "Returns the poses that can be had by now, on the clock of the samples.")
      .def("flush", &BoundLive::flush, py::call_guard<py::gil_scoped_release>(),
           "Returns the remaining poses, when the performance ends.")
      .def_property_readonly("skeleton", &BoundLive::skeleton, "The skeleton of the poses.")
      .def_property_readonly(
          "rate_hz", [](BoundLive& b) { return b.live().rate_hz(); }, "Poses a second.")
      .def_property_readonly(
          "latency_s", [](BoundLive& b) { return b.live().latency_s(); },
          "How long after its reading a pose is ready, s.")
      .def_property_readonly(
          "history_s", [](BoundLive& b) { return b.live().history_s(); },
          "How far back the readings of a pose reach, s.")
      .def_property_readonly(
          "num_skipped", [](BoundLive& b) { return b.live().num_skipped(); },
          "Readings that came faster than poses could be made of them.");
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
  bind_values(m);
  bind_live(m);
  m.def("reconstruct", &reconstruct_take, py::arg("take"), py::arg("sensors"), py::arg("request"),
        py::kw_only(), py::arg("best_quality") = false, py::arg("progress") = py::none(),
        "Returns the Reconstruction of a whole take: a SensorRecording and a SensorInput a sensor. "
        "Raises ConfigError and Cancelled.");
}

}  // namespace sparse_mocap::python
