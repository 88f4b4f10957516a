// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/motion_database.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/safetensors.hpp"

namespace sparse_mocap {

// Turns checked bytes into a database; every claim of the file is verified on the way.
class DatabaseReader {
 public:
  DatabaseReader(std::shared_ptr<const Bytes> bytes, const std::filesystem::path& path)
      : path_(path), view_(parse_safetensors(bytes->view(), path)) {
    database_.bytes_ = std::move(bytes);
    database_.path_ = path;
  }

  MotionDatabase read() {
    check_version();
    try {
      check_checksums();
      read_settings();
      read_arrays();
      read_clips();
    } catch (const nlohmann::json::exception&) {
      refuse("its metadata is damaged");
    }
    check_values();
    return std::move(database_);
  }

 private:
  using json = nlohmann::json;

  [[noreturn]] void refuse(const std::string& problem) const {
    throw FormatError({path_}, "not a sound motion database: " + problem,
                      "build it again with 'sparse-mocap database build'");
  }

  const std::string& text(const char* key) const {
    const auto at = view_.metadata.find(key);
    if (at == view_.metadata.end()) refuse(std::string("'") + key + "' is missing");
    return at->second;
  }

  void check_version() const {
    if (!view_.metadata.contains("format") || text("format") != "sparse_mocap_database")
      refuse("it is a safetensors file of something else");
    const std::string& version = text("format_version");
    if (version == std::to_string(kDatabaseFormatVersion)) return;
    throw FormatError({path_},
                      "is a motion database of format version " + version + ", this is version " +
                          std::to_string(kDatabaseFormatVersion),
                      "build it again with 'sparse-mocap database build'");
  }

  void check_checksums() const {
    if (metadata_checksum(view_.metadata) != text(kMetadataChecksum))
      refuse("its metadata does not match its checksum");
    const json checksums = json::parse(text("checksums"));
    for (const auto& tensor : view_.tensors)
      if (checksum(tensor.bytes) != checksums.at(tensor.name).get<std::string>())
        refuse("the array '" + tensor.name + "' does not match its checksum");
  }

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
    const Tensor& tensor = view_.find(name, path_);
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
    map_array(database_.up_, "up", f32, sites);
    map_array(database_.clip_index_, "clip_index", ElementType::i32, 1);
  }

  void read_clips() {
    int expected_begin = 0;
    for (const auto& entry : json::parse(text("clips"))) {
      Clip clip;
      clip.name = entry.at("name").get<std::string>();
      clip.actor = entry.at("actor").get<std::string>();
      clip.motion_class = entry.at("class").get<std::string>();
      clip.source = entry.at("source").get<std::string>();
      clip.source_hash = entry.at("source_hash").get<std::string>();
      clip.is_mirrored = entry.at("mirrored").get<bool>();
      clip.is_reversed = entry.at("reversed").get<bool>();
      clip.tempo = entry.at("tempo").get<double>();
      if (!(clip.tempo > 0.0)) refuse("the tempo of clip '" + clip.name + "' is not positive");
      clip.begin = entry.at("begin").get<int>();
      clip.end = entry.at("end").get<int>();
      if (clip.begin != expected_begin || clip.end <= clip.begin ||
          clip.end > database_.num_frames())
        refuse("the frames of clip '" + clip.name + "' do not follow the clip before it");
      for (int frame = clip.begin; frame < clip.end; ++frame)
        if (database_.clip_index(frame) != static_cast<int>(database_.clips_.size()))
          refuse("a frame of clip '" + clip.name + "' names another clip");
      expected_begin = clip.end;
      database_.clips_.push_back(std::move(clip));
    }
    if (expected_begin != database_.num_frames()) refuse("frames without a clip");
  }

  void check_values() const {
    for (const FloatRows* rows :
         {&database_.angles_, &database_.positions_, &database_.root_motion_, &database_.contacts_,
          &database_.specific_force_pivot_, &database_.specific_force_end_,
          &database_.angular_velocity_, &database_.up_})
      if (!rows->allFinite()) refuse("a value is not a number");
  }

  std::filesystem::path path_;
  SafetensorsView view_;
  std::size_t num_frames_ = 0;
  MotionDatabase database_;
};

std::shared_ptr<const MotionDatabase> MotionDatabase::from_bytes(
    std::shared_ptr<const Bytes> bytes, const std::filesystem::path& path) {
  return std::make_shared<const MotionDatabase>(DatabaseReader(std::move(bytes), path).read());
}

std::shared_ptr<const MotionDatabase> MotionDatabase::open(const std::filesystem::path& path) {
  return from_bytes(map_file(path), path);
}

}  // namespace sparse_mocap
