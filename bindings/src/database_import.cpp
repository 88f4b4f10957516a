// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <map>

#include "common.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/source_files.hpp"

namespace sparse_mocap::python {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
using Callback = std::optional<py::function>;
using Labels = std::map<fs::path, std::array<std::string, 4>>;  // actor, class, origin, license

ImportOptions import_options(const std::vector<std::string>& exclude, bool strict,
                             bool keep_duplicates, int num_threads, const Labels& labels,
                             const std::vector<std::string>& label_warnings,
                             const JointNames& by_hand, const std::optional<fs::path>& mappings) {
  ImportOptions options;
  options.exclude = exclude;
  options.is_strict = strict;
  options.keep_duplicates = keep_duplicates;
  options.num_threads = num_threads;
  for (const auto& [path, said] : labels)
    options.labels[path] = {said[0], said[1], said[2], said[3]};
  options.label_warnings = label_warnings;
  options.mapping = {by_hand, mappings.value_or(fs::path())};
  return options;
}

// Each with its name in a database.
std::vector<std::pair<fs::path, py::str>> named_motion_files(
    const Paths& sources, const std::vector<std::string>& exclude) {
  std::vector<std::pair<fs::path, py::str>> named;
  for (const auto& file : find_source_files(sources, exclude))
    named.emplace_back(file.path, text_of(file.name));
  return named;
}

Paths motion_files(const Paths& sources, const std::vector<std::string>& exclude) {
  const py::gil_scoped_release release;
  Paths paths;
  for (const auto& file : find_source_files(sources, exclude)) paths.push_back(file.path);
  return paths;
}

BuildReport build(const Paths& sources, const fs::path& output, double rate_hz, bool mirror,
                  bool reverse, const std::vector<double>& tempo_copies,
                  const std::vector<std::string>& exclude, bool strict, bool keep_duplicates,
                  int num_threads, const Labels& labels,
                  const std::vector<std::string>& label_warnings, const JointNames& by_hand,
                  const std::optional<fs::path>& mappings, const Callback& callback,
                  const Callback& details) {
  BuildOptions options{import_options(exclude, strict, keep_duplicates, num_threads, labels,
                                      label_warnings, by_hand, mappings)};
  options.rate_hz = rate_hz;
  options.add_mirrored = mirror;
  options.add_reversed = reverse;
  options.tempo_copies = tempo_copies;
  const Progress progress = progress_from(callback, details);
  const py::gil_scoped_release release;
  return build_database(sources, output, options, progress);
}

BuildReport add(const fs::path& database, const Paths& sources,
                const std::optional<fs::path>& output, const std::vector<std::string>& exclude,
                bool strict, bool keep_duplicates, int num_threads, const Labels& labels,
                const std::vector<std::string>& label_warnings, const JointNames& by_hand,
                const std::optional<fs::path>& mappings, const Callback& callback,
                const Callback& details) {
  const ImportOptions options = import_options(exclude, strict, keep_duplicates, num_threads,
                                               labels, label_warnings, by_hand, mappings);
  const Progress progress = progress_from(callback, details);
  const py::gil_scoped_release release;
  return add_to_database(database, sources, output.value_or(database), options, progress);
}

int drop(const fs::path& database, const std::vector<std::string>& clips,
         const std::optional<fs::path>& output) {
  const py::gil_scoped_release release;
  return drop_from_database(database, clips, output.value_or(database));
}

py::list pairs_of(const std::vector<SkippedFile>& files) {
  py::list pairs;
  for (const auto& file : files)
    pairs.append(py::make_tuple(text_of(file.path.string()), text_of(file.reason)));
  return pairs;
}

py::list texts_of(const std::vector<std::string>& lines) {
  py::list texts;
  for (const auto& line : lines) texts.append(text_of(line));
  return texts;
}

void bind_reports(py::module_& m) {
  py::class_<ProgressReport>(m, "ProgressReport")
      .def_readonly("done", &ProgressReport::done)
      .def_readonly("total", &ProgressReport::total)
      .def_property_readonly("what",
                             [](const ProgressReport& r) { return text_of(std::string(r.what)); })
      .def_readonly("files", &ProgressReport::files)
      .def_readonly("num_files", &ProgressReport::num_files)
      .def_readonly("frames", &ProgressReport::frames)
      .def_readonly("bytes", &ProgressReport::bytes)
      .def_readonly("num_bytes", &ProgressReport::num_bytes);

  py::class_<BuildReport>(m, "BuildReport")
      .def_readonly("num_files", &BuildReport::num_files)
      .def_readonly("num_known", &BuildReport::num_known)
      .def_readonly("num_replaced", &BuildReport::num_replaced)
      .def_readonly("num_clips", &BuildReport::num_clips)
      .def_readonly("num_frames", &BuildReport::num_frames)
      .def_readonly("source_frames", &BuildReport::source_frames)
      .def_readonly("source_bytes", &BuildReport::source_bytes)
      .def_readonly("elapsed_s", &BuildReport::elapsed_s)
      .def_property_readonly("skipped", [](const BuildReport& r) { return pairs_of(r.skipped); })
      .def_property_readonly("duplicates",
                             [](const BuildReport& r) { return pairs_of(r.duplicates); })
      .def_property_readonly("warnings", [](const BuildReport& r) { return texts_of(r.warnings); });
}

}  // namespace

void bind_database_import(py::module_& m) {
  bind_reports(m);
  const std::vector<std::string> no_patterns;
  m.def("find_motion_files", &motion_files, py::arg("sources"), py::arg("exclude") = no_patterns);
  m.def("named_motion_files", &named_motion_files, py::arg("sources"),
        py::arg("exclude") = no_patterns);
  m.def("build_database", &build, py::arg("sources"), py::arg("output"), py::kw_only(),
        py::arg("rate_hz") = 25.0, py::arg("mirror") = false, py::arg("reverse") = false,
        py::arg("tempo_copies") = BuildOptions().tempo_copies, py::arg("exclude") = no_patterns,
        py::arg("strict") = false, py::arg("keep_duplicates") = false, py::arg("num_threads") = 0,
        py::arg("labels") = Labels(), py::arg("label_warnings") = no_patterns,
        py::arg("by_hand") = JointNames(), py::arg("mappings") = py::none(),
        py::arg("progress") = py::none(), py::arg("details") = py::none());
  m.def("add_to_database", &add, py::arg("database"), py::arg("sources"),
        py::arg("output") = py::none(), py::kw_only(), py::arg("exclude") = no_patterns,
        py::arg("strict") = false, py::arg("keep_duplicates") = false, py::arg("num_threads") = 0,
        py::arg("labels") = Labels(), py::arg("label_warnings") = no_patterns,
        py::arg("by_hand") = JointNames(), py::arg("mappings") = py::none(),
        py::arg("progress") = py::none(), py::arg("details") = py::none());
  m.def("drop_from_database", &drop, py::arg("database"), py::arg("clips"),
        py::arg("output") = py::none());
}

}  // namespace sparse_mocap::python
