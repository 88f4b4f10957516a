// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/version_1.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "sparse_mocap/database/database_metadata.hpp"
#include "sparse_mocap/database/mapped_rows.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/packed_rows.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {
namespace {

class Reader {
 public:
  explicit Reader(const Container& container)
      : container_(container), metadata_(read_database_metadata(container)) {}

  DatabaseContent read() {
    map_arrays();
    check_clip_index();
    check_directions();
    DatabaseContent content;
    content.skeleton = metadata_.skeleton;
    content.rate_hz = metadata_.rate_hz;
    content.sources = std::move(metadata_.sources);
    content.build_info = metadata_.build_info;
    content.site_names = metadata_.site_names;
    for (const Clip& clip : metadata_.clips) content.clip_rows.push_back(packed(rows_of(clip)));
    content.clips = std::move(metadata_.clips);
    content.further = further_content();
    return content;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { container_.refuse(problem); }

  template <typename Scalar>
  RowsView<Scalar> mapped(const char* name, std::size_t columns) {
    const auto rows = mapped_rows<Scalar>(container_, name, columns);
    own_arrays_.insert(name);
    const Eigen::Index expected = metadata_.clips.empty() ? 0 : metadata_.clips.back().end;
    if (rows.rows() != expected) refuse("its clips do not cover its frames");
    return rows;
  }

  FloatRows mapped_floats(const char* name, std::size_t columns) {
    const FloatRows rows = mapped<float>(name, columns);
    if (!rows.allFinite()) refuse("a value is not a number");
    if (rows.size() > 0 && rows.cwiseAbs().maxCoeff() > kLargestPacked)
      refuse("a value is impossible");
    return rows;
  }

  void map_arrays() {
    const std::size_t sites = 3 * metadata_.site_names.size();
    for (const auto& [rows, name, columns] :
         {std::tuple{&angles_, "angles", std::size_t{kNumStandardAngles}},
          {&positions_, "positions", std::size_t{3 * kNumStandardJoints}},
          {&root_motion_, "root_motion", std::size_t{root_motion_column::count}},
          {&contacts_, "contacts", std::size_t{2}},
          {&specific_force_pivot_, "specific_force_pivot", sites},
          {&specific_force_end_, "specific_force_end", sites},
          {&angular_velocity_, "angular_velocity", sites},
          {&gravity_direction_, "up", sites}})
      new (rows) FloatRows(mapped_floats(name, columns));
    new (&clip_index_) RowsView<std::int32_t>(mapped<std::int32_t>("clip_index", 1));
  }

  void check_clip_index() const {
    int index = 0;
    for (const Clip& clip : metadata_.clips) {
      for (int frame = clip.begin; frame < clip.end; ++frame)
        if (clip_index_(frame, 0) != index)
          refuse("a frame of clip '" + clip.name + "' names another clip");
      ++index;
    }
  }

  void check_directions() const {
    for (Eigen::Index at = 0; at < gravity_direction_.cols(); at += 3)
      if (((gravity_direction_.middleCols(at, 3).rowwise().norm().array() - 1.0F).abs() > 1e-3F)
              .any())
        refuse("a direction has not unit length");
  }

  DatabaseRows rows_of(const Clip& clip) const {
    const auto of_clip = [&](const FloatRows& rows) {
      return DatabaseRows::Rows(rows.middleRows(clip.begin, clip.num_frames()));
    };
    return {of_clip(angles_),
            of_clip(positions_),
            of_clip(root_motion_),
            of_clip(contacts_),
            of_clip(specific_force_pivot_),
            of_clip(specific_force_end_),
            of_clip(angular_velocity_),
            of_clip(gravity_direction_),
            DatabaseRows::Rows::Zero(clip.num_frames(), Eigen::Index{3 * kNumExtremities})};
  }

  SafetensorsView further_content() const {
    SafetensorsView further;
    for (const auto& [key, value] : container_.metadata())
      if (!database_metadata_keys().contains(key) && !container_keys().contains(key))
        further.metadata.emplace(key, value);
    for (const auto& tensor : container_.tensors())
      if (!own_arrays_.contains(tensor.name)) further.tensors.push_back(tensor);
    return further;
  }

  const Container& container_;
  DatabaseMetadata metadata_;
  std::set<std::string> own_arrays_;
  FloatRows angles_{nullptr, 0, 0}, positions_{nullptr, 0, 0}, root_motion_{nullptr, 0, 0};
  FloatRows contacts_{nullptr, 0, 0};
  FloatRows specific_force_pivot_{nullptr, 0, 0}, specific_force_end_{nullptr, 0, 0};
  FloatRows angular_velocity_{nullptr, 0, 0}, gravity_direction_{nullptr, 0, 0};
  RowsView<std::int32_t> clip_index_{nullptr, 0, 0};
};

}  // namespace

DatabaseContent content_of_version_1(const Container& container) {
  return Reader(container).read();
}

}  // namespace sparse_mocap
