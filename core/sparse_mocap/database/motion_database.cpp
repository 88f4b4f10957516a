// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/motion_database.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/stored_models.hpp"

namespace sparse_mocap {

// Turns checked bytes into a database; every claim of the file is verified on the way.
class DatabaseReader {
 public:
  DatabaseReader(std::shared_ptr<const Bytes> bytes, const std::filesystem::path& path)
      : container_(bytes->view(), path, kDatabaseFormat) {
    database_.bytes_ = std::move(bytes);
    database_.path_ = path;
  }

  MotionDatabase read() {
    try {
      read_settings();
      read_arrays();
      read_sources();
      read_clips();
    } catch (const nlohmann::json::exception&) {
      refuse("its metadata is damaged");
    }
    check_values();
    read_further();
    return std::move(database_);
  }

 private:
  using json = nlohmann::json;

  [[noreturn]] void refuse(const std::string& problem) const { container_.refuse(problem); }

  const std::string& text(const char* key) const { return container_.text(key); }

  void read_settings() {
    database_.rate_hz_ = json::parse(text("rate_hz")).get<double>();
    if (!(database_.rate_hz_ >= 1.0 && database_.rate_hz_ <= 1000.0))
      refuse("its frame rate is not between 1 and 1000 Hz");
    database_.build_info_ = text("build");
    database_.site_names_ = json::parse(text("sites")).get<std::vector<std::string>>();
    if (database_.site_names_.empty()) refuse("it has no sensor sites");
    const json joints = json::parse(text("skeleton"));
    StandardBones bones;
    if (joints.size() != bones.size()) refuse("its skeleton has not 21 joints");
    for (std::size_t j = 0; j < bones.size(); ++j) {
      if (joints[j].at("name").get<std::string>() != standard_joint_names()[j])
        refuse("its skeleton has other joints");
      const auto bone = joints[j].at("bone_m").get<std::array<double, 3>>();
      bones[j] = {bone[0], bone[1], bone[2]};
      if (!bones[j].allFinite() || bones[j].norm() > 10.0) refuse("a bone's length is impossible");
    }
    database_.skeleton_ = make_standard_skeleton(bones);
  }

  template <typename Scalar>
  void map_array(RowsView<Scalar>& rows, const char* name, ElementType type, std::size_t columns) {
    const Tensor& tensor = container_.tensor(name);
    if (!container_.has_checksum(name))
      refuse(std::string("the array '") + name + "' has no checksum");
    own_arrays_.insert(name);
    if (tensor.type != type || tensor.shape.size() != 2 || tensor.shape[1] != columns)
      refuse(std::string("the array '") + name + "' has not " + std::to_string(columns) +
             " columns");
    if (reinterpret_cast<std::uintptr_t>(tensor.bytes.data()) % alignof(Scalar) != 0)
      refuse(std::string("the array '") + name + "' is not aligned");
    if (num_frames_ == 0) num_frames_ = tensor.shape[0];
    if (tensor.shape[0] != num_frames_ || num_frames_ == 0)
      refuse("its arrays have different lengths or none");
    if (num_frames_ > 2'000'000'000 / columns) refuse("it has too many frames");
    new (&rows) RowsView<Scalar>(reinterpret_cast<const Scalar*>(tensor.bytes.data()),
                                 static_cast<Eigen::Index>(tensor.shape[0]),
                                 static_cast<Eigen::Index>(columns));
  }

  void read_arrays() {
    const auto f32 = ElementType::f32;
    const std::size_t sites = 3 * database_.site_names_.size();
    map_array(database_.angles_, "angles", f32, kNumStandardAngles);
    map_array(database_.positions_, "positions", f32, 3 * kNumStandardJoints);
    map_array(database_.root_motion_, "root_motion", f32, root_motion_column::count);
    map_array(database_.contacts_, "contacts", f32, 2);
    map_array(database_.specific_force_pivot_, "specific_force_pivot", f32, sites);
    map_array(database_.specific_force_end_, "specific_force_end", f32, sites);
    map_array(database_.angular_velocity_, "angular_velocity", f32, sites);
    map_array(database_.gravity_direction_, "up", f32, sites);
    map_array(database_.clip_index_, "clip_index", ElementType::i32, 1);
  }

  static Clip clip_from(const json& entry) {
    Clip clip;
    clip.name = entry.at("name").get<std::string>();
    clip.actor = entry.at("actor").get<std::string>();
    clip.motion_class = entry.at("class").get<std::string>();
    clip.source = entry.at("source").get<std::string>();
    clip.source_hash = entry.at("source_hash").get<std::string>();
    clip.is_mirrored = entry.at("mirrored").get<bool>();
    clip.is_reversed = entry.at("reversed").get<bool>();
    clip.tempo = entry.at("tempo").get<double>();
    clip.begin = entry.at("begin").get<int>();
    clip.end = entry.at("end").get<int>();
    // Not in every database:
    clip.skeleton = entry.value("skeleton", "");
    clip.skeleton_hash = entry.value("skeleton_hash", "");
    clip.origin = entry.value("origin", "");
    clip.license = entry.value("license", "");
    clip.source_frames = entry.value("source_frames", 0);
    clip.source_rate_hz = entry.value("source_rate_hz", 0.0);
    clip.warnings = entry.value("warnings", std::map<std::string, int>());
    return clip;
  }

  void check_clip(const Clip& clip, int expected_begin) const {
    const auto refuse_clip = [&](const char* problem) {
      refuse("clip '" + clip.name + "' " + problem);
    };
    if (clip.begin != expected_begin || clip.end <= clip.begin || clip.end > database_.num_frames())
      refuse("the frames of clip '" + clip.name + "' do not follow the clip before it");
    for (int frame = clip.begin; frame < clip.end; ++frame)
      if (database_.clip_index(frame) != static_cast<int>(database_.clips_.size()))
        refuse("a frame of clip '" + clip.name + "' names another clip");
    if (!(clip.tempo > 0.0 && clip.tempo < 100.0)) refuse_clip("has an impossible tempo");
    if (clip.source_frames < 0 || !(clip.source_rate_hz >= 0.0 && clip.source_rate_hz < 1e6))
      refuse_clip("has an impossible source");
    const auto& skeletons = database_.sources_.skeletons;
    if (!clip.skeleton.empty() &&
        std::none_of(skeletons.begin(), skeletons.end(),
                     [&](const SourceSkeleton& known) { return known.id == clip.skeleton; }))
      refuse_clip("names an unknown skeleton");
  }

  void read_clips() {
    int expected_begin = 0;
    for (const auto& entry : json::parse(text("clips"))) {
      Clip clip = clip_from(entry);
      check_clip(clip, expected_begin);
      expected_begin = clip.end;
      database_.clips_.push_back(std::move(clip));
    }
    if (expected_begin != database_.num_frames()) refuse("frames without a clip");
  }

  static std::vector<LeftOut> left_out_from(const json& entries) {
    std::vector<LeftOut> files;
    for (const auto& entry : entries)
      files.push_back(
          {entry.at("source").get<std::string>(), entry.at("reason").get<std::string>()});
    return files;
  }

  void read_sources() {
    if (!container_.metadata().contains("sources")) return;  // not in every database
    const json sources = json::parse(text("sources"));
    for (const auto& entry : sources.at("skeletons")) {
      SourceSkeleton skeleton;
      skeleton.id = entry.at("id").get<std::string>();
      skeleton.num_joints = entry.at("num_joints").get<int>();
      skeleton.joints = entry.at("joints").get<std::map<std::string, std::string>>();
      skeleton.unit_scale = entry.at("unit_scale").get<double>();
      if (skeleton.id.empty() || skeleton.num_joints < 1 ||
          !(skeleton.unit_scale > 0.0 && skeleton.unit_scale < 1e9))
        refuse("the skeleton '" + skeleton.id + "' of its sources is impossible");
      database_.sources_.skeletons.push_back(std::move(skeleton));
    }
    database_.sources_.skipped = left_out_from(sources.at("skipped"));
    database_.sources_.duplicates = left_out_from(sources.at("duplicates"));
  }

  void check_values() const {
    for (const FloatRows* rows :
         {&database_.angles_, &database_.positions_, &database_.root_motion_, &database_.contacts_,
          &database_.specific_force_pivot_, &database_.specific_force_end_,
          &database_.angular_velocity_, &database_.gravity_direction_})
      if (!rows->allFinite()) refuse("a value is not a number");
    const FloatRows& directions = database_.gravity_direction_;
    for (Eigen::Index at = 0; at < directions.cols(); at += 3)
      if (((directions.middleCols(at, 3).rowwise().norm().array() - 1.0F).abs() > 1e-3F).any())
        refuse("a direction has not unit length");
  }

  void read_further() {
    static const std::set<std::string> own_keys{"rate_hz", "filter", "skeleton", "sites",
                                                "clips",   "build",  "sources"};
    SafetensorsView& further = database_.further_;
    for (const auto& [key, value] : container_.metadata())
      if (!own_keys.contains(key) && !container_keys().contains(key))
        further.metadata.emplace(key, value);
    for (const auto& tensor : container_.tensors())
      if (!own_arrays_.contains(tensor.name)) further.tensors.push_back(tensor);
    try {
      database_.model_names_ = stored_methods(further.metadata);
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
    for (const auto& method : database_.model_names_)
      for (const auto& tensor : further.tensors)
        if (is_of_model(tensor, method) && !container_.has_checksum(tensor.name))
          refuse("the array '" + tensor.name + "' has no checksum");
  }

  Container container_;
  std::set<std::string> own_arrays_;
  std::size_t num_frames_ = 0;
  MotionDatabase database_;
};

Model MotionDatabase::model(const std::string& method) const {
  require_model(method);
  try {
    Model model = stored_model(further_, method);
    model.path = path_;
    return model;
  } catch (const std::invalid_argument& error) {
    throw FormatError({path_}, "the model of '" + method + "' is not sound: " + error.what(),
                      kModelFormat.remedy);
  }
}

void MotionDatabase::require_model(const std::string& method) const {
  if (std::find(model_names_.begin(), model_names_.end(), method) != model_names_.end()) return;
  std::string names;
  for (const auto& name : model_names_) names += (names.empty() ? "" : ", ") + name;
  throw FormatError({path_}, "holds no model of '" + method + "'",
                    names.empty() ? "it holds no models" : "it holds models of " + names);
}

std::shared_ptr<const MotionDatabase> MotionDatabase::from_bytes(
    std::shared_ptr<const Bytes> bytes, const std::filesystem::path& path) {
  return std::make_shared<const MotionDatabase>(DatabaseReader(std::move(bytes), path).read());
}

std::shared_ptr<const MotionDatabase> MotionDatabase::open(const std::filesystem::path& path) {
  return from_bytes(map_file(path), path);
}

}  // namespace sparse_mocap
