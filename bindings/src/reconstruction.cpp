// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/methods/baselines.hpp"
#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {
namespace {

using Database = std::shared_ptr<MotionDatabase>;

py::array_t<double> to_array(const Eigen::VectorXd& values, const std::vector<py::ssize_t>& shape) {
  auto out = new_array(shape);
  std::copy(values.data(), values.data() + values.size(), out.mutable_data());
  return out;
}

// One estimate and the skeleton that its angles belong to.
struct BoundEstimate {
  PoseEstimate estimate;
  Database database;

  py::array_t<double> rotations() const {
    const auto quaternions = joint_rotations(estimate, database->skeleton());
    auto out = new_array({static_cast<py::ssize_t>(quaternions.size()), 4});
    double* value = out.mutable_data();
    for (const Quat& q : quaternions)
      for (const double v : {q.w(), q.x(), q.y(), q.z()}) *value++ = v;
    return out;
  }
};

struct Reconstruction {
  std::vector<PoseEstimate> estimates;
  Database database;

  // One row an estimate.
  py::array_t<double> stacked(Eigen::VectorXd PoseEstimate::*member,
                              std::vector<py::ssize_t> row_shape) const {
    row_shape.insert(row_shape.begin(), static_cast<py::ssize_t>(estimates.size()));
    auto out = new_array(row_shape);
    double* value = out.mutable_data();
    for (const auto& estimate : estimates) {
      const Eigen::VectorXd& row = estimate.*member;
      value = std::copy(row.data(), row.data() + row.size(), value);
    }
    return out;
  }
  py::array_t<std::int64_t> indices(int PoseEstimate::*member) const {
    py::array_t<std::int64_t> out(static_cast<py::ssize_t>(estimates.size()));
    for (std::size_t t = 0; t < estimates.size(); ++t)
      out.mutable_at(static_cast<py::ssize_t>(t)) = estimates[t].*member;
    return out;
  }
};

// A method with the database and sensors that it was made for.
class BoundReconstructor {
 public:
  BoundReconstructor(Database database, const std::vector<std::string>& sites,
                     const std::string& method, const std::string& preset,
                     const std::optional<std::vector<double>>& places,
                     const std::optional<std::vector<std::string>>& quantities,
                     const std::vector<int>& excluded_clips)
      : database_(std::move(database)), num_sensors_(sites.size()) {
    const auto sensors = sensors_from(sites, places, quantities);
    const py::gil_scoped_release release;
    method_ = make_method(method, preset, database_, sensors, excluded_clips);
  }

  int latency_frames() const { return method_->latency_frames(); }
  void reset() { method_->reset(); }

  std::optional<BoundEstimate> step(const Doubles& specific_force) {
    require_shape(specific_force, {static_cast<py::ssize_t>(num_sensors_), 3}, "specific_force");
    // Row-major S x 3 is column-major 3 x S.
    const Reading reading = Eigen::Map<const Reading>(specific_force.data(), 3,
                                                      static_cast<Eigen::Index>(num_sensors_));
    std::optional<PoseEstimate> estimate;
    {
      const py::gil_scoped_release release;
      estimate = method_->step(reading);
    }
    if (!estimate) return std::nullopt;
    return BoundEstimate{std::move(*estimate), database_};
  }

  std::vector<BoundEstimate> flush() {
    std::vector<PoseEstimate> owed;
    {
      const py::gil_scoped_release release;
      owed = method_->flush();
    }
    std::vector<BoundEstimate> bound;
    for (auto& estimate : owed) bound.push_back({std::move(estimate), database_});
    return bound;
  }

  Reconstruction solve(const Doubles& specific_force, bool offline,
                       const std::optional<py::function>& callback) {
    const auto take = readings_from(specific_force, num_sensors_);
    const Progress progress = progress_from(callback);
    const py::gil_scoped_release release;
    return {offline ? method_->solve(take, progress) : solve_online(*method_, take, progress),
            database_};
  }

 private:
  Database database_;
  std::size_t num_sensors_;
  std::unique_ptr<Method> method_;
};

std::vector<std::string> as_strings(const std::vector<std::string_view>& names) {
  return {names.begin(), names.end()};
}

// Runs work, which must not touch Python, and gives its result to NumPy.
template <typename Work>
py::array_t<std::int64_t> without_gil(const Work& work) {
  std::vector<int> values;
  {
    const py::gil_scoped_release release;
    values = work();
  }
  py::array_t<std::int64_t> out(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

void bind_estimates(py::module_& m) {
  py::class_<BoundEstimate>(m, "PoseEstimate")
      .def_property_readonly("angles",
                             [](const BoundEstimate& b) {
                               return to_array(b.estimate.angles, {b.estimate.angles.size()});
                             })
      .def_property_readonly(
          "positions",
          [](const BoundEstimate& b) {
            return to_array(b.estimate.positions, {b.estimate.positions.size() / 3, 3});
          })
      .def_property_readonly("rotations", &BoundEstimate::rotations)
      .def_property_readonly(
          "root_position",
          [](const BoundEstimate& b) { return to_array(b.estimate.root_position, {3}); })
      .def_property_readonly("yaw_rad", [](const BoundEstimate& b) { return b.estimate.yaw_rad; })
      .def_property_readonly(
          "contacts", [](const BoundEstimate& b) { return to_array(b.estimate.contacts, {2}); })
      .def_property_readonly("spread_m",
                             [](const BoundEstimate& b) {
                               return to_array(b.estimate.spread_m, {b.estimate.spread_m.size()});
                             })
      .def_property_readonly("sensor_misfit_mps2",
                             [](const BoundEstimate& b) {
                               return to_array(b.estimate.sensor_misfit_mps2,
                                               {b.estimate.sensor_misfit_mps2.size()});
                             })
      .def_property_readonly("clip", [](const BoundEstimate& b) { return b.estimate.clip; })
      .def_property_readonly("database_frame",
                             [](const BoundEstimate& b) { return b.estimate.database_frame; });

  py::class_<Reconstruction>(m, "Reconstruction")
      .def_property_readonly("motion",
                             [](const Reconstruction& r) {
                               return to_motion(r.estimates, r.database->skeleton(),
                                                r.database->rate_hz());
                             })
      .def_property_readonly("angles",
                             [](const Reconstruction& r) {
                               return r.stacked(&PoseEstimate::angles, {kNumStandardAngles});
                             })
      .def_property_readonly("positions",
                             [](const Reconstruction& r) {
                               return r.stacked(&PoseEstimate::positions, {kNumStandardJoints, 3});
                             })
      .def_property_readonly(
          "contacts",
          [](const Reconstruction& r) {
            auto out = new_array({static_cast<py::ssize_t>(r.estimates.size()), 2});
            double* value = out.mutable_data();
            for (const auto& e : r.estimates)
              value = std::copy(e.contacts.data(), e.contacts.data() + 2, value);
            return out;
          })
      .def_property_readonly("spread_m",
                             [](const Reconstruction& r) {
                               return r.stacked(&PoseEstimate::spread_m, {kNumStandardJoints});
                             })
      .def_property_readonly(
          "sensor_misfit_mps2",
          [](const Reconstruction& r) {
            const py::ssize_t sensors =
                r.estimates.empty() ? 0 : r.estimates.front().sensor_misfit_mps2.size();
            return r.stacked(&PoseEstimate::sensor_misfit_mps2, {sensors});
          })
      .def_property_readonly("clips",
                             [](const Reconstruction& r) { return r.indices(&PoseEstimate::clip); })
      .def_property_readonly("database_frames", [](const Reconstruction& r) {
        return r.indices(&PoseEstimate::database_frame);
      });
}

void bind_baselines(py::module_& m) {
  m.def(
      "playback_best_path",
      [](const Database& database, const std::vector<std::string>& sites,
         const Doubles& specific_force, const std::vector<int>& excluded_clips) {
        const auto take = readings_from(specific_force, sites.size());
        const auto sensors = sensors_from(sites, std::nullopt);
        return without_gil(
            [&] { return playback_best_path(*database, sensors, take, excluded_clips); });
      },
      py::arg("database"), py::arg("sites"), py::arg("specific_force"),
      py::arg("excluded_clips") = std::vector<int>{});
  m.def(
      "nearest_windows",
      [](const Database& database, const std::vector<std::string>& sites,
         const Doubles& specific_force, int window, const std::vector<int>& excluded_clips) {
        const auto take = readings_from(specific_force, sites.size());
        const auto sensors = sensors_from(sites, std::nullopt);
        return without_gil(
            [&] { return nearest_windows(*database, sensors, take, window, excluded_clips); });
      },
      py::arg("database"), py::arg("sites"), py::arg("specific_force"), py::arg("window") = 10,
      py::arg("excluded_clips") = std::vector<int>{});
  m.def(
      "nearest_poses",
      [](const Database& database, const Doubles& positions,
         const std::vector<int>& excluded_clips) {
        require_shape(positions, {-1, kNumStandardJoints, 3}, "positions");
        const Eigen::MatrixXd columns = Eigen::Map<const Eigen::MatrixXd>(
            positions.data(), 3 * kNumStandardJoints, positions.shape(0));
        return without_gil([&] { return nearest_poses(*database, columns, excluded_clips); });
      },
      py::arg("database"), py::arg("positions"), py::arg("excluded_clips") = std::vector<int>{});
}

}  // namespace

void bind_reconstruction(py::module_& m) {
  bind_estimates(m);
  bind_baselines(m);
  m.def("method_names", [] { return as_strings(method_names()); });
  m.def(
      "preset_names", [](const std::string& method) { return as_strings(method_presets(method)); },
      py::arg("method"));
  py::class_<BoundReconstructor>(m, "Reconstructor")
      .def(py::init<Database, const std::vector<std::string>&, const std::string&,
                    const std::string&, const std::optional<std::vector<double>>&,
                    const std::optional<std::vector<std::string>>&, const std::vector<int>&>(),
           py::arg("database"), py::arg("sites"), py::kw_only(), py::arg("method") = "tautges2011",
           py::arg("preset") = "default", py::arg("places") = py::none(),
           py::arg("quantities") = py::none(), py::arg("excluded_clips") = std::vector<int>{})
      .def_property_readonly("latency_frames", &BoundReconstructor::latency_frames)
      .def("step", &BoundReconstructor::step, py::arg("specific_force"))
      .def("flush", &BoundReconstructor::flush)
      .def("reset", &BoundReconstructor::reset)
      .def("solve", &BoundReconstructor::solve, py::arg("specific_force"), py::kw_only(),
           py::arg("offline") = false, py::arg("progress") = py::none());
}

}  // namespace sparse_mocap::python
