// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::python {
namespace {

using Database = std::shared_ptr<const MotionDatabase>;

const FloatRows& rows_named(const MotionDatabase& database, const std::string& name) {
  if (name == "angles") return database.angles();
  if (name == "positions") return database.positions();
  if (name == "root_motion") return database.root_motion();
  if (name == "contacts") return database.contacts();
  if (name == "specific_force_pivot") return database.specific_force_pivot();
  if (name == "specific_force_end") return database.specific_force_end();
  if (name == "angular_velocity") return database.angular_velocity();
  if (name == "up") return database.up();
  throw py::key_error("a motion database has no array '" + name + "'");
}

// A read-only view that keeps the database alive.
py::array view_of(const Database& database, const std::string& name) {
  const FloatRows& rows = rows_named(*database, name);
  py::array view(py::dtype::of<float>(), {rows.rows(), rows.cols()}, rows.data(),
                 py::cast(database));
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

// A clip's rows turned back into a motion: poses from the angles, the root by integration.
Motion clip_motion(const MotionDatabase& database, int index) {
  if (index < 0 || index >= static_cast<int>(database.clips().size()))
    throw py::index_error("the database has " + std::to_string(database.clips().size()) + " clips");
  const Clip& clip = database.clips()[static_cast<std::size_t>(index)];
  std::vector<PoseEstimate> estimates;
  Vec3 position = Vec3::Zero();
  double yaw = 0.0;
  for (int frame = clip.begin; frame < clip.end; ++frame) {
    const auto rates = database.root_motion().row(frame).cast<double>();
    using namespace root_motion_column;
    if (frame > clip.begin) {
      position += yaw_rotation(yaw) * Vec3(rates[velocity_left], 0.0, rates[velocity_forward]) *
                  database.frame_time_s();
      yaw += rates[yaw_rate] * database.frame_time_s();
    }
    position.y() = rates[height];
    PoseEstimate estimate;
    estimate.angles = database.angles().row(frame).transpose().cast<double>();
    estimate.root_position = position;
    estimate.yaw_rad = yaw;
    estimates.push_back(std::move(estimate));
  }
  return to_motion(estimates, database.skeleton(), database.rate_hz());
}

BuildReport build(const std::vector<std::filesystem::path>& sources,
                  const std::filesystem::path& output, double rate_hz, bool mirror, bool reverse,
                  const std::vector<double>& tempo_copies, const std::vector<std::string>& exclude,
                  bool strict, const std::optional<py::function>& callback) {
  BuildOptions options;
  options.rate_hz = rate_hz;
  options.add_mirrored = mirror;
  options.add_reversed = reverse;
  options.tempo_copies = tempo_copies;
  options.exclude = exclude;
  options.is_strict = strict;
  const Progress progress = progress_from(callback);
  const py::gil_scoped_release release;
  return build_database(sources, output, options, progress);
}

}  // namespace

void bind_database(py::module_& m) {
  py::class_<Clip>(m, "Clip")
      .def_readonly("name", &Clip::name)
      .def_readonly("actor", &Clip::actor)
      .def_readonly("motion_class", &Clip::motion_class)
      .def_readonly("source", &Clip::source)
      .def_readonly("source_hash", &Clip::source_hash)
      .def_readonly("is_mirrored", &Clip::is_mirrored)
      .def_readonly("is_reversed", &Clip::is_reversed)
      .def_readonly("tempo", &Clip::tempo)
      .def_readonly("begin", &Clip::begin)
      .def_readonly("end", &Clip::end);

  py::class_<MotionDatabase, std::shared_ptr<MotionDatabase>>(m, "MotionDatabase")
      .def(py::init([](const std::filesystem::path& path) {
             const py::gil_scoped_release release;
             return std::const_pointer_cast<MotionDatabase>(MotionDatabase::open(path));
           }),
           py::arg("path"))
      .def_property_readonly("path", [](const MotionDatabase& d) { return d.path().string(); })
      .def_property_readonly("num_frames", &MotionDatabase::num_frames)
      .def_property_readonly("rate_hz", &MotionDatabase::rate_hz)
      .def_property_readonly("skeleton", [](const MotionDatabase& d) { return d.skeleton(); })
      .def_property_readonly("clips", [](const MotionDatabase& d) { return d.clips(); })
      .def_property_readonly("site_names", &MotionDatabase::site_names)
      .def_property_readonly("build_info", &MotionDatabase::build_info)
      .def(
          "array",
          [](const std::shared_ptr<MotionDatabase>& d, const std::string& name) {
            return view_of(d, name);
          },
          py::arg("name"))
      .def("clip_motion", &clip_motion, py::arg("index"));

  py::class_<BuildReport>(m, "BuildReport")
      .def_readonly("num_files", &BuildReport::num_files)
      .def_readonly("num_clips", &BuildReport::num_clips)
      .def_readonly("num_frames", &BuildReport::num_frames)
      .def_property_readonly("skipped",
                             [](const BuildReport& report) {
                               std::vector<std::pair<std::string, std::string>> skipped;
                               for (const auto& file : report.skipped)
                                 skipped.emplace_back(file.path.string(), file.reason);
                               return skipped;
                             })
      .def_readonly("warnings", &BuildReport::warnings);

  m.def("find_motion_files", &find_motion_files, py::arg("sources"),
        py::arg("exclude") = std::vector<std::string>(), py::call_guard<py::gil_scoped_release>());
  m.def("build_database", &build, py::arg("sources"), py::arg("output"), py::kw_only(),
        py::arg("rate_hz") = 25.0, py::arg("mirror") = false, py::arg("reverse") = false,
        py::arg("tempo_copies") = BuildOptions().tempo_copies,
        py::arg("exclude") = std::vector<std::string>{}, py::arg("strict") = false,
        py::arg("progress") = py::none());
}

}  // namespace sparse_mocap::python
