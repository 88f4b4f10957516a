// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/motion_database.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/database/mapped_rows.hpp"
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/database/stored_models.hpp"
#include "sparse_mocap/database/version_1.hpp"

namespace sparse_mocap {

// Turns checked bytes into a database; every claim of the file is verified on the way.
class DatabaseReader {
 public:
  DatabaseReader(const Container& container, std::shared_ptr<const Bytes> bytes,
                 const std::filesystem::path& path)
      : container_(container) {
    database_.bytes_ = std::move(bytes);
    database_.path_ = path;
    database_.metadata_ = read_database_metadata(container);
  }

  MotionDatabase read() {
    read_clips();
    read_arrays();
    check_values();
    read_further();
    return std::move(database_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { container_.refuse(problem); }

  void read_clips() {
    const auto& clips = database_.clips();
    if (clips.empty()) refuse("it has no clips");
    if (mapped_rows<std::int16_t>(container_, "angles", kNumStandardAngles).rows() !=
        clips.back().end)
      refuse("its clips do not cover its frames");
    for (const Clip& clip : clips)
      database_.clip_of_row_.resize(static_cast<std::size_t>(clip.end), num_clips_++);
  }

  template <typename Scalar>
  RowsView<Scalar> mapped(const std::string& name, std::size_t columns, Eigen::Index rows) {
    const auto view = mapped_rows<Scalar>(container_, name, columns);
    if (view.rows() != rows)
      refuse("the array '" + name + "' does not have " + std::to_string(rows) + " rows");
    own_arrays_.insert(name);
    own_checksums_ += container_.checksums().at(name);
    return view;
  }

  ScaledRows scaled(const std::string& name, std::size_t columns) {
    const auto values = mapped<std::int16_t>(name, columns, database_.num_frames());
    const FloatRows scales = mapped<float>(scale_name(name), 1, num_clips_);
    const auto is_scale = scales.array() > 1e-30F && scales.array() < 1e26F;
    if (!is_scale.all()) refuse("a scale of the array '" + name + "' is impossible");
    return {values, scales.data(), database_.clip_of_row_.data()};
  }

  void read_arrays() {
    const Eigen::Index rows = database_.num_frames();
    database_.angles_ = scaled("angles", kNumStandardAngles);
    database_.positions_ = scaled("positions", 3 * kNumStandardJoints);
    new (&database_.root_motion_)
        FloatRows(mapped<float>("root_motion", root_motion_column::count, rows));
    new (&database_.contacts_) RowsView<std::uint8_t>(mapped<std::uint8_t>("contacts", 2, rows));
    if (std::any_of(database_.clips().begin(), database_.clips().end(), has_any_extremity))
      database_.extremities_ = scaled("extremities", 3 * kNumExtremities);
    for (const auto& site : database_.site_names()) {
      const auto of_site = [&](const char* name) { return scaled(site_array(site, name), 3); };
      database_.sites_.push_back({of_site("specific_force_pivot"), of_site("specific_force_end"),
                                  of_site("angular_velocity"), of_site("up")});
      if (has_real_orientation(database_.clips(), site))
        database_.sites_.back().orientation = scaled(site_array(site, "orientation"), 4);
    }
    for (const char* key : {"skeleton", "clips", "rate_hz"}) own_checksums_ += container_.text(key);
    database_.rows_hash_ = checksum(std::as_bytes(std::span(own_checksums_)));
  }

  void check_values() const {
    if (!database_.root_motion_.allFinite()) refuse("a value is not a number");
    if ((database_.contacts_.array() > 1).any()) refuse("a contact is neither 0 nor 1");
    for (const SiteRows& site : database_.sites_) {
      if (!are_directions(site.gravity_direction)) refuse("a direction has not unit length");
      if (!are_rotations(site.orientation)) refuse("an orientation has not unit length");
    }
  }

  // Or zero.
  bool are_rotations(const ScaledRows& rows) const {
    for (Eigen::Index n = 0; n < rows.rows(); ++n) {
      const float length = rows.row(n).norm();
      if (length != 0.0F && std::abs(length - 1.0F) > 1e-3F) return false;
    }
    return true;
  }

  bool are_directions(const ScaledRows& rows) const {
    for (const Clip& clip : database_.clips()) {
      const auto lengths = rows.rows_of_clip(clip.begin, clip.num_frames()).rowwise().norm();
      if (((lengths.array() - 1.0F).abs() > 1e-3F).any()) return false;
    }
    return true;
  }

  void read_further() {
    SafetensorsView& further = database_.further_;
    for (const auto& [key, value] : container_.metadata())
      if (!database_metadata_keys().contains(key) && !container_keys().contains(key))
        further.metadata.emplace(key, value);
    for (const auto& tensor : container_.tensors())
      if (!own_arrays_.contains(tensor.name)) further.tensors.push_back(tensor);
    try {
      database_.model_names_ = stored_methods(further.metadata);
      database_.sections_ = sections_of(further);
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
    for (const auto& tensor : further.tensors)
      if ((is_of_some_model(tensor) || is_of_section(tensor)) &&
          !container_.has_checksum(tensor.name))
        refuse("the array '" + tensor.name + "' has no checksum");
  }

  bool is_of_some_model(const Tensor& tensor) const {
    const auto& methods = database_.model_names_;
    return std::any_of(methods.begin(), methods.end(),
                       [&](const std::string& method) { return is_of_model(tensor, method); });
  }

  const Container& container_;
  std::set<std::string> own_arrays_;
  std::string own_checksums_;
  int num_clips_ = 0;
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

const Section* MotionDatabase::section(const std::string& name) const {
  const auto at = sections_.find(name);
  if (at == sections_.end()) return nullptr;
  const bool is_stale = !at->second.rows.empty() && at->second.rows != rows_hash_;
  return is_stale ? nullptr : &at->second;
}

void MotionDatabase::require_model(const std::string& method) const {
  if (std::find(model_names_.begin(), model_names_.end(), method) != model_names_.end()) return;
  std::string names;
  for (const auto& name : model_names_) names += (names.empty() ? "" : ", ") + name;
  throw FormatError({path_}, "holds no model of '" + method + "'",
                    names.empty() ? "it holds no models" : "it holds models of " + names);
}

namespace {

// A file of version 1 as one of the newest version.
std::vector<std::byte> upgraded(const Container& container) {
  try {
    return encode_database(content_of_version_1(container));
  } catch (const std::invalid_argument& error) {
    container.refuse(error.what());
  }
}

}  // namespace

std::shared_ptr<const MotionDatabase> MotionDatabase::from_bytes(
    std::shared_ptr<const Bytes> bytes, const std::filesystem::path& path) {
  const Container container(*bytes, path, kDatabaseFormat);
  if (container.version() == 1) return from_bytes(own_bytes(upgraded(container)), path);
  return std::make_shared<const MotionDatabase>(
      DatabaseReader(container, std::move(bytes), path).read());
}

std::shared_ptr<const MotionDatabase> MotionDatabase::open(const std::filesystem::path& path) {
  return from_bytes(map_file(path), path);
}

}  // namespace sparse_mocap
