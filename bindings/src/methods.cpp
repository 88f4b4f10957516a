// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods.hpp"

#include "readings.hpp"
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/methods/reconstruct.hpp"
#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/readings/channel_names.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::python {
namespace {

using Database = std::shared_ptr<MotionDatabase>;

const char* kind_name(OptionInfo::Kind kind) {
  switch (kind) {
    case OptionInfo::Kind::number:
      return "number";
    case OptionInfo::Kind::integer:
      return "integer";
    case OptionInfo::Kind::flag:
      return "flag";
    case OptionInfo::Kind::choice:
      break;
  }
  return "choice";
}

py::dict option_dict(const OptionInfo& option) {
  const bool has_range =
      option.kind == OptionInfo::Kind::number || option.kind == OptionInfo::Kind::integer;
  py::dict out;
  out["name"] = option.name;
  out["kind"] = kind_name(option.kind);
  out["help"] = option.help;
  out["default"] = option.default_value;
  if (has_range) out["lowest"] = option.lowest;
  if (has_range) out["highest"] = option.highest;
  if (!option.choices.empty()) out["choices"] = option.choices;
  return out;
}

py::dict experiment_dict(const Experiment& experiment) {
  py::list variants, pairs;
  for (const auto& variant : experiment.variants) {
    py::dict options;
    for (const auto& [name, value] : variant.options) options[name.c_str()] = value;
    py::dict sensors;
    for (const Sensor& sensor : variant.sensors)
      sensors[py::str(std::string(all_sites()[static_cast<std::size_t>(sensor.site)].name))] =
          names_of(sensor.channels);
    py::dict told;
    told["label"] = variant.label;
    told["options"] = options;
    told["sensors"] = sensors;
    told["method"] = variant.method;
    told["in_best_quality"] = variant.in_best_quality;
    told["knows_all_clips"] = variant.knows_all_clips;
    variants.append(told);
  }
  for (const auto& pair : experiment.pairs) pairs.append(py::make_tuple(pair.training, pair.test));
  py::dict out;
  out["name"] = experiment.name;
  out["help"] = experiment.help;
  out["variants"] = variants;
  out["pairs"] = pairs;
  out["error"] =
      experiment.error == Experiment::Error::position_cm ? "position_cm" : "joint_angle_deg";
  return out;
}

template <typename Item, typename Convert>
py::list list_of(const std::vector<Item>& items, const Convert& convert) {
  py::list out;
  for (const auto& item : items) out.append(convert(item));
  return out;
}

py::dict method_dict(const MethodEntry& method) {
  const MethodInfo& info = method.info;
  py::list needs;
  if (info.needs_database) needs.append("database");
  if (info.needs_model) needs.append("model");
  if (info.needs_body) needs.append("body");
  py::dict channels, sensors, out;
  channels["required"] = names_of(info.required_channels);
  channels["optional"] = names_of(info.optional_channels);
  channels["one_of"] = names_of(info.one_channel_of);
  sensors["fewest"] = info.fewest_sensors;
  sensors["most"] = info.most_sensors;
  out["name"] = info.name;
  out["title"] = info.title;
  out["summary"] = info.summary;
  out["paper"] = info.paper;
  out["presets"] = list_of(info.presets, [](const PresetInfo& preset) {
    return py::dict(py::arg("name") = preset.name, py::arg("help") = preset.help);
  });
  out["options"] = list_of(info.options, option_dict);
  out["needs"] = needs;
  out["channels"] = channels;
  out["sensors"] = sensors;
  out["works_live"] = method.make_live != nullptr;
  out["works_on_whole_takes"] = method.make_whole_take != nullptr;
  out["can_be_trained"] = method.train != nullptr;
  out["experiments"] = list_of(info.experiments, experiment_dict);
  return out;
}

ReconstructionRequest request_from(const std::string& method, const std::string& preset,
                                   const std::map<std::string, std::string>& options,
                                   const Database& database, const std::shared_ptr<Model>& model,
                                   const std::optional<Skeleton>& body,
                                   const std::vector<int>& excluded_clips, double tracker_yaw_rad,
                                   const std::vector<double>& tracker_origin_m) {
  if (tracker_origin_m.size() != 3) throw py::value_error("tracker_origin_m has three numbers");
  ReconstructionRequest request;
  request.method = method;
  request.settings = {preset, {options.begin(), options.end()}};
  request.database = database;
  request.model = model;
  request.body = body;
  request.excluded_clips = excluded_clips;
  request.tracker_world = {tracker_yaw_rad, Vec3(tracker_origin_m.data())};
  return request;
}

using Segments = std::vector<std::pair<double, std::string>>;

Segments segments_in(const TrainingClip& clip) {
  Segments segments;
  for (const auto& segment : clip.segments) segments.emplace_back(segment.begin_s, segment.label);
  return segments;
}

void set_segments(TrainingClip& clip, const Segments& segments) {
  clip.segments.clear();
  for (const auto& [begin_s, label] : segments) clip.segments.push_back({begin_s, label});
}

TrainingClip clip_from(const std::string& name, const Motion& motion,
                       const std::string& motion_class, const std::optional<Readings>& readings,
                       const Segments& segments) {
  TrainingClip clip{name, motion_class, motion, {}, {}};
  set_segments(clip, segments);
  if (readings) {
    clip.sensors = readings->sensors;
    clip.readings = readings->readings;
  }
  return clip;
}

std::shared_ptr<Model> train(const std::string& method, const std::vector<TrainingClip>& clips,
                             const std::string& preset,
                             const std::map<std::string, std::string>& options,
                             const std::optional<py::function>& callback) {
  const Progress progress = progress_from(callback);
  const py::gil_scoped_release release;
  const MethodSettings settings{preset, {options.begin(), options.end()}};
  return std::make_shared<Model>(train_model(find_method(method), settings, clips, progress));
}

Segments segments(const std::string& method, const TrainingClip& clip, const std::string& preset,
                  const std::map<std::string, std::string>& options) {
  const MethodSettings settings{preset, {options.begin(), options.end()}};
  Segments found;
  for (const auto& segment : segments_of_clip(find_method(method), settings, clip))
    found.emplace_back(segment.begin_s, segment.label);
  return found;
}

}  // namespace

void bind_methods(py::module_& m) {
  m.def(
      "method_infos", [] { return list_of(methods(), method_dict); },
      R"doc(Returns the methods' descriptions, the default first, as values that JSON can hold.

sparse_mocap.method_info() returns one of them as a MethodInfo.)doc");
  py::class_<ReconstructionRequest>(m, "ReconstructionRequest",
                                    "How a performance is to be reconstructed.")
      .def(py::init(&request_from), py::kw_only(), py::arg("method") = "", py::arg("preset") = "",
           py::arg("options") = std::map<std::string, std::string>{},
           py::arg("database") = py::none(), py::arg("model") = py::none(),
           py::arg("body") = py::none(), py::arg("excluded_clips") = std::vector<int>{},
           py::arg("tracker_yaw_rad") = 0.0,
           py::arg("tracker_origin_m") = std::vector<double>{0.0, 0.0, 0.0},
           R"doc(An empty method or preset means the default; options map names to values as text.

database, model and body (a standard skeleton) are given where the method needs them.
excluded_clips are indices of database clips that are not used. tracker_* as in
ReadingStream. Raises ValueError unless tracker_origin_m has three numbers.)doc");
  py::class_<TrainingClip>(m, "TrainingClip", "One example that a model is trained from.")
      .def(
          py::init(&clip_from), py::arg("name"), py::arg("motion"), py::kw_only(),
          py::arg("motion_class") = "", py::arg("readings") = py::none(),
          py::arg("segments") = Segments{},
          R"doc(Takes a motion on a standard skeleton, feet and hands or not; an empty class is unknown.

readings were recorded with the motion, at its rate; None: they are simulated. segments are
times (s) and labels as clip_segments() returns them; none: the method finds them.)doc")
      .def_readonly("name", &TrainingClip::name, "Of messages.")
      .def_readwrite("motion_class", &TrainingClip::motion_class, "Empty: unknown.")
      .def_property("segments", &segments_in, &set_segments, "As clip_segments() returns them.")
      .def_readonly("motion", &TrainingClip::motion, "On a standard skeleton.");
  m.def("train", &train, py::arg("method"), py::arg("clips"), py::kw_only(), py::arg("preset") = "",
        py::arg("options") = std::map<std::string, std::string>{}, py::arg("progress") = py::none(),
        R"doc(Returns the model that a method learns from clips.

Raises ConfigError for a method that learns nothing and for what it cannot use, and Cancelled.)doc");
  m.def("clip_segments", &segments, py::arg("method"), py::arg("clip"), py::kw_only(),
        py::arg("preset") = "", py::arg("options") = std::map<std::string, std::string>{},
        py::call_guard<py::gil_scoped_release>(),
        R"doc(Returns the parts that training divides a clip into: when each begins (s), its label.

Raises ConfigError for a method that divides none, and for a clip that it cannot use.)doc");
}

}  // namespace sparse_mocap::python
