// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "common.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/source_files.hpp"
#include "sparse_mocap/readings/take_alignment.hpp"

namespace sparse_mocap::python {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;
using Callback = std::optional<py::function>;
// actor, class, origin, license; rate in Hz, 0: not said
using Labels =
    std::map<fs::path, std::tuple<std::string, std::string, std::string, std::string, double>>;
using Takes = std::map<fs::path, PairedTake>;

// What a Python function gives for requests: an iterator over the answers, None while the next is
// not there yet.
NextAnswer answers_of(const py::function& function, const std::vector<std::string>& requests) {
  const py::gil_scoped_acquire gil;
  py::list asked;
  for (const auto& request : requests) asked.append(py::bytes(request));
  const std::shared_ptr<py::iterator> answers(new py::iterator(py::iter(function(asked))),
                                              [](py::iterator* iterator) {
                                                const py::gil_scoped_acquire held;
                                                delete iterator;
                                              });
  return [answers]() -> std::optional<std::string> {
    const py::gil_scoped_acquire held;
    const auto answer = py::reinterpret_steal<py::object>(PyIter_Next(answers->ptr()));
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
    if (!answer) throw std::runtime_error("a motion file was asked about and got no answer");
    if (answer.is_none()) return std::nullopt;
    return answer.cast<std::string>();
  };
}

RemoteWork remote_from(const Callback& function) {
  if (!function) return {};
  return [function](const std::vector<std::string>& requests) {
    return answers_of(*function, requests);
  };
}

ImportOptions import_options(const std::vector<std::string>& exclude, bool strict,
                             bool keep_duplicates, int num_threads, const Labels& labels,
                             const std::vector<std::string>& label_warnings,
                             const JointNames& by_hand, const std::optional<fs::path>& mappings,
                             const ReadOptions& read, const Callback& remote) {
  ImportOptions options;
  options.exclude = exclude;
  options.is_strict = strict;
  options.keep_duplicates = keep_duplicates;
  options.num_threads = num_threads;
  for (const auto& [path, said] : labels) {
    const auto& [actor, motion_class, origin, license, rate_hz] = said;
    options.labels[path] = {actor, motion_class, origin, license, rate_hz};
  }
  options.label_warnings = label_warnings;
  options.mapping = {by_hand, mappings.value_or(fs::path())};
  options.read = read;
  options.remote = remote_from(remote);
  return options;
}

py::bytes answer(const std::string& request, const ReadOptions& read) {
  std::string bytes;
  {
    const py::gil_scoped_release release;
    bytes = answer_to(request, read);
  }
  return bytes;
}

// Each with its name in a database.
std::vector<std::pair<fs::path, py::str>> named_motion_files(
    const Paths& sources, const std::vector<std::string>& exclude, const ReadOptions& read) {
  std::vector<std::pair<fs::path, py::str>> named;
  for (const auto& file : find_source_files(sources, exclude, read))
    named.emplace_back(file.path, text_of(file.name));
  return named;
}

Paths motion_files(const Paths& sources, const std::vector<std::string>& exclude,
                   const ReadOptions& read) {
  const py::gil_scoped_release release;
  Paths paths;
  for (const auto& file : find_source_files(sources, exclude, read)) paths.push_back(file.path);
  return paths;
}

BuildReport build(const Paths& sources, const fs::path& output, double rate_hz, bool mirror,
                  bool reverse, const std::vector<double>& tempo_copies, bool own_proportions,
                  const std::vector<std::string>& exclude, bool strict, bool keep_duplicates,
                  int num_threads, const Labels& labels,
                  const std::vector<std::string>& label_warnings, const JointNames& by_hand,
                  const std::optional<fs::path>& mappings, const ReadOptions& read,
                  const Callback& remote, const Callback& callback, const Callback& details) {
  BuildOptions options{import_options(exclude, strict, keep_duplicates, num_threads, labels,
                                      label_warnings, by_hand, mappings, read, remote)};
  options.rate_hz = rate_hz;
  options.add_mirrored = mirror;
  options.add_reversed = reverse;
  options.tempo_copies = tempo_copies;
  options.has_own_proportions = own_proportions;
  const Progress progress = progress_from(callback, details);
  const py::gil_scoped_release release;
  return build_database(sources, output, options, progress);
}

BuildReport add(const fs::path& database, const Paths& sources,
                const std::optional<fs::path>& output, const std::vector<std::string>& exclude,
                bool strict, bool keep_duplicates, int num_threads, const Labels& labels,
                const std::vector<std::string>& label_warnings, const JointNames& by_hand,
                const std::optional<fs::path>& mappings, const ReadOptions& read, bool rebuild,
                const Takes& takes, const Callback& remote, const Callback& callback,
                const Callback& details) {
  ImportOptions options = import_options(exclude, strict, keep_duplicates, num_threads, labels,
                                         label_warnings, by_hand, mappings, read, remote);
  options.takes = takes;
  const Progress progress = progress_from(callback, details);
  const py::gil_scoped_release release;
  const auto change = rebuild ? &rebuild_database : &add_to_database;
  return change(database, sources, output.value_or(database), options, progress);
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
  py::class_<ProgressReport>(m, "ProgressReport", R"doc(How far an import is: done of total steps.

files of num_files are through in this pass over them (there are two) and hold so many frames;
bytes of num_bytes are read, over all passes.)doc")
      .def_readonly("done", &ProgressReport::done, "Steps done.")
      .def_readonly("total", &ProgressReport::total, "Steps in all.")
      .def_property_readonly(
          "what", [](const ProgressReport& r) { return text_of(std::string(r.what)); },
          "What is being done.")
      .def_readonly("files", &ProgressReport::files, "Files done in this pass.")
      .def_readonly("num_files", &ProgressReport::num_files, "Files in all.")
      .def_readonly("frames", &ProgressReport::frames, "Frames in the files done.")
      .def_readonly("bytes", &ProgressReport::bytes, "Bytes read, over all passes.")
      .def_readonly("num_bytes", &ProgressReport::num_bytes, "Bytes to be read, over all passes.");

  py::class_<BuildReport>(m, "BuildReport", R"doc(What an import did.

num_files, source_frames and source_bytes are what it took in, num_clips and num_frames what
the database holds; num_known files were in already, num_replaced of num_files took the place
of what they held before. skipped (unusable), duplicates and doubtful are (path, reason).)doc")
      .def_readonly("num_files", &BuildReport::num_files, "Files read.")
      .def_readonly("num_known", &BuildReport::num_known, "Files that were in it already.")
      .def_readonly("num_replaced", &BuildReport::num_replaced,
                    "Files that took the place of what they held before.")
      .def_readonly("num_clips", &BuildReport::num_clips, "Clips of the database.")
      .def_readonly("num_frames", &BuildReport::num_frames, "Rows of the database.")
      .def_readonly("source_frames", &BuildReport::source_frames, "Frames of the files read.")
      .def_readonly("source_bytes", &BuildReport::source_bytes, "Bytes of the files read.")
      .def_readonly("elapsed_s", &BuildReport::elapsed_s, "How long it took.")
      .def_property_readonly(
          "skipped", [](const BuildReport& r) { return pairs_of(r.skipped); },
          "Files that could not be used, and why.")
      .def_property_readonly(
          "duplicates", [](const BuildReport& r) { return pairs_of(r.duplicates); },
          "Files whose motion was there already, and where.")
      .def_property_readonly(
          "doubtful", [](const BuildReport& r) { return pairs_of(r.doubtful); },
          "Files taken in whose motion is doubtful, and why; the worst first.")
      .def_property_readonly(
          "warnings", [](const BuildReport& r) { return texts_of(r.warnings); }, "One line each.");
}

TakeAlignment aligned(const Motion& motion, const std::vector<SensorRecording>& recordings,
                      const std::vector<SensorInput>& sensors,
                      const std::optional<std::pair<double, double>>& event,
                      const Callback& callback) {
  if (recordings.size() != sensors.size() || sensors.empty())
    throw py::value_error("align_take: a recording for each sensor is needed");
  const Progress progress = progress_from(callback);
  const py::gil_scoped_release release;
  return align_take(motion, recordings, sensors, event, progress);
}

void bind_takes(py::module_& m) {
  py::class_<TakeAlignment>(m, "TakeAlignment",
                            R"doc(Where in a take a motion was performed, and how well both agree.

Correlations are 1 at most, however the sensors are mounted; unrelated movements have about 0.5.)doc")
      .def_readonly("begin_s", &TakeAlignment::begin_s,
                    "When the motion begins, on the take's clock.")
      .def_readonly("correlation", &TakeAlignment::correlation,
                    "Of measured with virtual readings, over all sensors.")
      .def_readonly("runner_up", &TakeAlignment::runner_up, "The best one at another time.")
      .def_readonly("coverage", &TakeAlignment::coverage,
                    "The part of the motion during which the take was recorded.")
      .def_readonly("sensor_correlations", &TakeAlignment::sensor_correlations,
                    "One a sensor, in their order.");
  m.def("align_take", &aligned, py::arg("motion"), py::arg("recordings"), py::arg("sensors"),
        py::kw_only(), py::arg("event") = py::none(), py::arg("progress") = py::none(),
        R"doc(Returns where in a take a motion of the standard skeleton was performed.

recordings: a SensorRecording for each of the sensors (SensorInput), all on one clock. event: when
on that clock a clap or a jump happened that the motion has too, from and to; it then decides the
time. Raises ConfigError for what is too short to be compared, ValueError for unlike numbers of
recordings and sensors, and Cancelled.)doc");
  py::class_<PairedTake>(m, "PairedTake", "What sensors recorded while a motion was performed.")
      .def(
          py::init([](std::string name, std::string hash, std::vector<SensorInput> sensors,
                      std::vector<SensorRecording> recordings, double begin_s, double correlation) {
            if (sensors.size() != recordings.size() || sensors.empty())
              throw py::value_error("PairedTake: a recording for each sensor is needed");
            return PairedTake{std::move(name),       std::move(hash), std::move(sensors),
                              std::move(recordings), begin_s,         correlation};
          }),
          py::arg("name"), py::arg("hash"), py::arg("sensors"), py::arg("recordings"),
          py::kw_only(), py::arg("begin_s"), py::arg("correlation"),
          R"doc(Takes the name and hash of the take file.

begin_s: when the motion begins on its clock; correlation: how well the readings agree with it, see
align_take. Raises ValueError for unlike numbers of sensors and recordings.)doc")
      .def_readonly("name", &PairedTake::name, "The take's file.")
      .def_readonly("hash", &PairedTake::hash, "Tells its content from any other.");
}

}  // namespace

void bind_database_import(py::module_& m) {
  bind_reports(m);
  bind_takes(m);
  const std::vector<std::string> no_patterns;
  m.def("find_motion_files", &motion_files, py::arg("sources"), py::arg("exclude") = no_patterns,
        py::arg("read") = ReadOptions(),
        R"doc(The motion files that the sources are or hold, without those excluded, sorted.

Raises FormatError when a source does not exist or nothing is left.)doc");
  m.def("named_motion_files", &named_motion_files, py::arg("sources"),
        py::arg("exclude") = no_patterns, py::arg("read") = ReadOptions(),
        R"doc(As find_motion_files, each with the name that its clips have as their source.)doc");
  m.def("build_database", &build, py::arg("sources"), py::arg("output"), py::kw_only(),
        py::arg("rate_hz") = 25.0, py::arg("mirror") = false, py::arg("reverse") = false,
        py::arg("tempo_copies") = BuildOptions().tempo_copies, py::arg("own_proportions") = false,
        py::arg("exclude") = no_patterns, py::arg("strict") = false,
        py::arg("keep_duplicates") = false, py::arg("num_threads") = 0,
        py::arg("labels") = Labels(), py::arg("label_warnings") = no_patterns,
        py::arg("by_hand") = JointNames(), py::arg("mappings") = py::none(),
        py::arg("read") = ReadOptions(), py::arg("remote") = py::none(),
        py::arg("progress") = py::none(), py::arg("details") = py::none(),
        R"doc(Builds a database from motion files, or folders of them, and writes it to output.

rate_hz is the database's frame rate; mirror, reverse and tempo_copies (factors) add copies of
each clip; own_proportions: readings are of each body's own, not the averaged ones; exclude: glob
patterns of files to leave out; labels: actor, class, origin, license and the rate (Hz, 0: not
said) by a motion file's path. strict: the first file that cannot be used or is doubtful ends it,
otherwise it is skipped or taken with a warning; keep_duplicates: files with the same motion are all
taken; num_threads 0: one for each processor; by_hand: the source's joint by standard joint;
mappings: the file of remembered mappings; read: what the files do not say; remote(requests): does
the work on files in place of this process, and gives an iterator over what answer_request says of
each request, None while the next is not there yet. Raises
FormatError, and Cancelled if progress returns False; the output is then left as it was.)doc");
  m.def("answer_request", &answer, py::arg("request"), py::arg("read"),
        R"doc(Does the work on a motion file that an import asks for, as bytes.

read: readers of further formats; all else is in the request. Raises ValueError for what is no
request of this version.)doc");
  m.def("add_to_database", &add, py::arg("database"), py::arg("sources"),
        py::arg("output") = py::none(), py::kw_only(), py::arg("exclude") = no_patterns,
        py::arg("strict") = false, py::arg("keep_duplicates") = false, py::arg("num_threads") = 0,
        py::arg("labels") = Labels(), py::arg("label_warnings") = no_patterns,
        py::arg("by_hand") = JointNames(), py::arg("mappings") = py::none(),
        py::arg("read") = ReadOptions(), py::arg("rebuild") = false, py::arg("takes") = Takes(),
        py::arg("remote") = py::none(), py::arg("progress") = py::none(),
        py::arg("details") = py::none(),
        R"doc(Adds motion files to a database, with the copies that it was built with.

output: where the result goes, None: in its place. rebuild: the sources hold the database's own
files too, and everything is built anew, so that its skeleton is averaged over all bodies.
takes: what sensors recorded while files were performed, by the files' paths. The rest is as in
build_database().)doc");
  m.def("drop_from_database", &drop, py::arg("database"), py::arg("clips"),
        py::arg("output") = py::none(),
        R"doc(Drops the clips whose name or source matches a glob pattern, and returns how many.

output: where the result goes, None: in its place. Raises FormatError.)doc");
}

}  // namespace sparse_mocap::python
