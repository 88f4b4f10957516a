// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "common.hpp"
#include "sparse_mocap/database/clip_motion.hpp"
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/sections.hpp"
#include "sparse_mocap/database/stored_models.hpp"
#include "sparse_mocap/readings/channel_names.hpp"

namespace sparse_mocap::python {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What all sites read, three columns each in the order of site_names.
Rows of_all_sites(const MotionDatabase& database, ScaledRows SiteRows::*member) {
  const std::size_t num_sites = database.site_names().size();
  Rows rows(database.num_frames(), static_cast<Eigen::Index>(3 * num_sites));
  for (std::size_t s = 0; s < num_sites; ++s)
    rows.middleCols(static_cast<Eigen::Index>(3 * s), 3) = (database.site(s).*member).all();
  return rows;
}

Rows rows_named(const MotionDatabase& database, const std::string& name) {
  if (name == "angles") return database.angles().all();
  if (name == "positions") return database.positions().all();
  if (name == "extremities") return database.extremities().all();
  if (name == "root_motion") return database.root_motion();
  if (name == "contacts") return database.contacts().cast<float>();
  if (name == "specific_force_pivot")
    return of_all_sites(database, &SiteRows::specific_force_pivot);
  if (name == "specific_force_end") return of_all_sites(database, &SiteRows::specific_force_end);
  if (name == "angular_velocity") return of_all_sites(database, &SiteRows::angular_velocity);
  if (name == "up") return of_all_sites(database, &SiteRows::gravity_direction);
  throw py::key_error("a motion database has no array '" + name + "'");
}

// A read-only array of its own memory.
py::array array_of(const MotionDatabase& database, const std::string& name) {
  auto rows = std::make_unique<Rows>(rows_named(database, name));
  const Rows& values = *rows;
  const py::capsule owner(rows.release(), [](void* p) { delete static_cast<Rows*>(p); });
  py::array array(py::dtype::of<float>(), {values.rows(), values.cols()}, values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

std::vector<std::pair<std::string, std::string>> pairs_of(const std::vector<LeftOut>& files) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& file : files) pairs.emplace_back(file.source, file.reason);
  return pairs;
}

// What is no model's and not the database's own: name, element type as safetensors calls it, shape,
// size in bytes.
py::list other_tensors(const MotionDatabase& database) {
  const auto is_of_some_model = [&](const Tensor& tensor) {
    const auto& names = database.model_names();
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& method) { return is_of_model(tensor, method); });
  };
  py::list rows;
  for (const auto& tensor : database.further().tensors)
    if (!is_of_some_model(tensor) && !is_of_section(tensor))
      rows.append(py::make_tuple(tensor.name, name_of(tensor.type),
                                 py::tuple(py::cast(tensor.shape)), tensor.bytes.size()));
  return rows;
}

std::size_t bytes_of(const ScaledRows& rows) {
  return static_cast<std::size_t>(rows.rows() * rows.cols()) * sizeof(std::int16_t);
}

std::map<std::string, std::size_t> array_bytes(const MotionDatabase& database) {
  const SiteRows& site = database.site(0);
  const std::size_t num_sites = database.site_names().size();
  const auto num_frames = static_cast<std::size_t>(database.num_frames());
  std::map<std::string, std::size_t> bytes{
      {"angles", bytes_of(database.angles())},
      {"positions", bytes_of(database.positions())},
      {"root_motion", root_motion_column::count * sizeof(float) * num_frames},
      {"contacts", 2 * num_frames},
      {"specific_force_pivot", num_sites * bytes_of(site.specific_force_pivot)},
      {"specific_force_end", num_sites * bytes_of(site.specific_force_end)},
      {"angular_velocity", num_sites * bytes_of(site.angular_velocity)},
      {"up", num_sites * bytes_of(site.gravity_direction)}};
  for (std::size_t s = 0; s < num_sites; ++s)
    if (const std::size_t own = bytes_of(database.site(s).orientation); own > 0)
      bytes["orientation"] += own;
  return bytes;
}

using Texts = std::map<std::string, std::string>;

std::optional<Texts> section_texts(const MotionDatabase& database, const std::string& name,
                                   int version) {
  const Section* section = database.section(name);
  if (section == nullptr || section->version != version) return std::nullopt;
  return section->metadata;
}

std::vector<std::string> section_names(const MotionDatabase& database) {
  std::vector<std::string> names;
  for (const auto& [name, section] : sections_of(database.further()))
    if (database.section(name) != nullptr) names.push_back(name);
  return names;
}

std::map<std::string, std::vector<std::string_view>> channels_in(const ClipTake& take) {
  std::map<std::string, std::vector<std::string_view>> names;
  for (const auto& [site, channels] : take.channels) names[site] = names_of(channels);
  return names;
}

void bind_clip_take(py::module_& m) {
  py::class_<ClipTake>(m, "ClipTake",
                       R"doc(What real sensors measured while a clip was performed.

The clip's rows hold it in place of what virtual sensors read.)doc")
      .def_readonly("name", &ClipTake::name, "The take's file.")
      .def_readonly("hash", &ClipTake::hash, "SHA-256 of the file.")
      .def_readonly("begin_s", &ClipTake::begin_s, "When the clip begins, on the take's clock.")
      .def_readonly("correlation", &ClipTake::correlation,
                    "How well the readings agree with the motion, see align_take.")
      .def_readonly("coverage", &ClipTake::coverage, "The part of the rows with real readings.")
      .def_property_readonly("channels", &channels_in,
                             "The channels, of CHANNEL_NAMES, by the sensors' sites.");
}

void bind_clips(py::module_& m) {
  bind_clip_take(m);
  py::class_<SourceSkeleton>(m, "SourceSkeleton",
                             R"doc(One kind of skeleton among a database's sources.

joints are the source's that move the standard ones; unit_scale times its lengths are metres.)doc")
      .def_readonly("id", &SourceSkeleton::id, "What Clip.skeleton names it by.")
      .def_readonly("num_joints", &SourceSkeleton::num_joints, "Joints of the source.")
      .def_readonly("joints", &SourceSkeleton::joints,
                    "The source's joint for each standard joint.")
      .def_readonly("unit_scale", &SourceSkeleton::unit_scale,
                    "Metres in one unit of the source's lengths.");

  py::class_<Clip>(m, "Clip", R"doc(A stretch of a database's rows.

source is the file, relative to the folder built from; hashes are XXH3 of it and of the .asf
that was read with it; skeleton is the id of its SourceSkeleton; origin and license are notes;
warnings are kinds of warnings about the file and how often (empty for copies).)doc")
      .def_readonly("name", &Clip::name, "Unique in the database.")
      .def_readonly("actor", &Clip::actor, "Who performed it; empty: not known.")
      .def_readonly("motion_class", &Clip::motion_class,
                    "What kind of movement it is; empty: not known.")
      .def_readonly("source", &Clip::source, "The file, relative to the folder built from.")
      .def_readonly("source_hash", &Clip::source_hash, "XXH3 of the file.")
      .def_readonly("skeleton_hash", &Clip::skeleton_hash,
                    "XXH3 of the .asf that was read with it; empty for other formats.")
      .def_readonly("skeleton", &Clip::skeleton, "The id of its SourceSkeleton.")
      .def_readonly("origin", &Clip::origin, "A note: where the file is from.")
      .def_readonly("license", &Clip::license, "A note: what may be done with it.")
      .def_readonly("source_frames", &Clip::source_frames, "Frames of the file.")
      .def_readonly("source_rate_hz", &Clip::source_rate_hz, "Frame rate of the file.")
      .def_readonly("warnings", &Clip::warnings,
                    "Kinds of warnings about the file and how often; empty for copies.")
      .def_readonly("is_mirrored", &Clip::is_mirrored, "Whether left and right are exchanged.")
      .def_readonly("is_reversed", &Clip::is_reversed, "Whether it runs backwards.")
      .def_readonly("tempo", &Clip::tempo, "How much faster than performed.")
      .def_readonly("take", &Clip::take,
                    "The take whose readings its rows hold; None: they are all virtual.")
      .def_readonly("begin", &Clip::begin, "Its first row.")
      .def_readonly("end", &Clip::end, "One past its last row.");
}

using DatabaseClass = py::class_<MotionDatabase, std::shared_ptr<MotionDatabase>>;

void bind_content(DatabaseClass& database) {
  database
      .def("array", &array_of, py::arg("name"), R"doc(A read-only copy of the rows as float32.

Names: angles, positions, extremities, root_motion, contacts, specific_force_pivot, specific_force_end,
angular_velocity, up.)doc")
      .def(
          "clip_motion",
          [](const MotionDatabase& d, int index, bool extremities) {
            return extremities ? clip_motion_with_extremities(d, index) : clip_motion(d, index);
          },
          py::arg("index"), py::kw_only(), py::arg("extremities") = false,
          R"doc(The clip as a motion on the standard skeleton, starting at the origin.

extremities: with feet, toes and hands, which are relaxed in clips whose files have none.)doc")
      .def_property_readonly("model_names", &MotionDatabase::model_names,
                             "The methods whose models it holds.")
      .def(
          "model",
          [](const MotionDatabase& d, const std::string& method) {
            return std::make_shared<Model>(d.model(method));
          },
          py::arg("method"),
          "What a method learned and keeps here, see store_model. Raises FormatError.")
      .def_property_readonly("array_bytes", &array_bytes,
                             "What its rows take in the file, by the names of array().")
      .def("section", &section_texts, py::arg("name"), py::arg("version"),
           "The texts of an optional part, None where it is missing or was made from other rows.")
      .def_property_readonly("sections", &section_names,
                             "The names of the optional parts that it holds.")
      .def_property_readonly("rows_hash", &MotionDatabase::rows_hash,
                             "Tells these rows from all others: XXH3, 16 hexadecimal digits.")
      .def_property_readonly(
          "other_tensors", &other_tensors,
          R"doc(Tensors that other programs put into the file: name, element type, shape, bytes.)doc");
}

}  // namespace

void bind_database(py::module_& m) {
  bind_clips(m);
  DatabaseClass database(m, "MotionDatabase", "An opened .smdb, read-only and thread-safe.");
  database
      .def(py::init([](const std::filesystem::path& path) {
             const py::gil_scoped_release release;
             return std::const_pointer_cast<MotionDatabase>(MotionDatabase::open(path));
           }),
           py::arg("path"), "Checks the whole file. Raises FormatError.")
      .def_property_readonly(
          "path", [](const MotionDatabase& d) { return d.path().string(); }, "The file.")
      .def_property_readonly("num_frames", &MotionDatabase::num_frames, "Rows, over all clips.")
      .def_property_readonly("rate_hz", &MotionDatabase::rate_hz, "Rows a second.")
      .def_property_readonly(
          "skeleton", [](const MotionDatabase& d) { return d.skeleton(); },
          "The standard skeleton that all its motions are on.")
      .def_property_readonly(
          "clips", [](const MotionDatabase& d) { return d.clips(); }, "In the order of their rows.")
      .def_property_readonly(
          "skeletons", [](const MotionDatabase& d) { return d.sources().skeletons; },
          "The kinds of skeletons among its sources.")
      .def_property_readonly(
          "skipped", [](const MotionDatabase& d) { return pairs_of(d.sources().skipped); },
          "Files that could not be used, and why.")
      .def_property_readonly(
          "duplicates", [](const MotionDatabase& d) { return pairs_of(d.sources().duplicates); },
          "Files whose motion was there already, and where.")
      .def_property_readonly("site_names", &MotionDatabase::site_names,
                             "Where its virtual sensors are worn.")
      .def_property_readonly("build_info", &MotionDatabase::build_info,
                             "JSON: options and counts of the build.");
  bind_content(database);
  m.def(
      "store_section",
      [](const std::filesystem::path& path, const std::string& name, const Texts& texts,
         int version, const std::string& rows) {
        store_section(path, name, {version, rows, texts, {}});
      },
      py::arg("database"), py::arg("name"), py::arg("texts"), py::kw_only(), py::arg("version"),
      py::arg("rows") = "", py::call_guard<py::gil_scoped_release>(),
      R"doc(Puts an optional part of texts into a motion database, in place of one of its name.

rows: the rows_hash of the rows that it was made from, empty when it belongs to any. The file is
replaced atomically. Raises FormatError, OSError and ValueError.)doc");
}

}  // namespace sparse_mocap::python
