// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/safetensors.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;
using Rows = DatabaseRows::Rows;

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json skeleton_json(const Skeleton& skeleton) {
  json joints = json::array();
  for (const auto& joint : skeleton.joints())
    joints.push_back({{"name", joint.name}, {"bone_m", vector_json(joint.bone)}});
  return joints;
}

json clips_json(const DatabaseContent& content) {
  json clips = json::array();
  int begin = 0;
  for (std::size_t c = 0; c < content.clips.size(); ++c) {
    const Clip& clip = content.clips[c];
    const int end = begin + content.clip_rows[c].num_frames();
    clips.push_back({{"name", clip.name},
                     {"actor", clip.actor},
                     {"class", clip.motion_class},
                     {"source", clip.source},
                     {"source_hash", clip.source_hash},
                     {"mirrored", clip.is_mirrored},
                     {"reversed", clip.is_reversed},
                     {"tempo", clip.tempo},
                     {"begin", begin},
                     {"end", end}});
    begin = end;
  }
  return clips;
}

struct Array {
  std::string name;
  ElementType type;
  std::vector<std::size_t> shape;
  std::vector<std::byte> bytes;
};

Array gathered(const char* name, const DatabaseContent& content, Rows DatabaseRows::*member) {
  Array array{name, ElementType::f32, {0, 0}, {}};
  for (const auto& rows : content.clip_rows) {
    const Rows& part = rows.*member;
    array.shape[0] += static_cast<std::size_t>(part.rows());
    array.shape[1] = static_cast<std::size_t>(part.cols());
    const auto bytes = std::as_bytes(std::span(part.data(), static_cast<std::size_t>(part.size())));
    array.bytes.insert(array.bytes.end(), bytes.begin(), bytes.end());
  }
  return array;
}

Array clip_indices(const DatabaseContent& content) {
  std::vector<std::int32_t> indices;
  for (std::size_t c = 0; c < content.clip_rows.size(); ++c)
    indices.insert(indices.end(), static_cast<std::size_t>(content.clip_rows[c].num_frames()),
                   static_cast<std::int32_t>(c));
  const auto bytes = std::as_bytes(std::span(indices));
  return {"clip_index", ElementType::i32, {indices.size(), 1}, {bytes.begin(), bytes.end()}};
}

std::vector<Array> all_arrays(const DatabaseContent& content) {
  std::vector<Array> arrays;
  arrays.push_back(gathered("angles", content, &DatabaseRows::angles));
  arrays.push_back(gathered("positions", content, &DatabaseRows::positions));
  arrays.push_back(gathered("root_motion", content, &DatabaseRows::root_motion));
  arrays.push_back(gathered("contacts", content, &DatabaseRows::contacts));
  arrays.push_back(gathered("specific_force_pivot", content, &DatabaseRows::specific_force_pivot));
  arrays.push_back(gathered("specific_force_end", content, &DatabaseRows::specific_force_end));
  arrays.push_back(gathered("angular_velocity", content, &DatabaseRows::angular_velocity));
  arrays.push_back(gathered("up", content, &DatabaseRows::up));
  arrays.push_back(clip_indices(content));
  return arrays;
}

std::map<std::string, std::string> metadata_of(const DatabaseContent& content,
                                               const std::vector<Array>& arrays) {
  json sites = json::array();
  for (const auto& site : all_sites()) sites.push_back(std::string(site.name));
  json checksums;
  for (const auto& array : arrays) checksums[array.name] = checksum(array.bytes);
  std::map<std::string, std::string> metadata{
      {"format", "sparse_mocap_database"},
      {"format_version", std::to_string(kDatabaseFormatVersion)},
      {"rate_hz", json(content.rate_hz).dump()},
      {"filter", json{{"kind", "gaussian"},
                      {"marker_sigma_s", kMarkerFilter.sigma_s},
                      {"reading_sigma_s", kReadingFilter.sigma_s}}
                     .dump()},
      {"skeleton", skeleton_json(content.skeleton).dump()},
      {"sites", sites.dump()},
      {"clips", clips_json(content).dump()},
      {"build", content.build_info},
      {"checksums", checksums.dump()},
  };
  metadata[kMetadataChecksum] = metadata_checksum(metadata);
  return metadata;
}

}  // namespace

std::vector<std::byte> encode_database(const DatabaseContent& content) {
  if (content.clips.empty() || content.clips.size() != content.clip_rows.size())
    throw std::invalid_argument("encode_database: clips and their rows do not correspond");
  const auto arrays = all_arrays(content);
  std::vector<Tensor> tensors;
  for (const auto& array : arrays)
    tensors.push_back({array.name, array.type, array.shape, array.bytes});
  const std::string header = safetensors_header(metadata_of(content, arrays), tensors);
  std::vector<std::byte> file;
  const auto append = [&](std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  };
  append(std::as_bytes(std::span(header)));
  for (const auto& array : arrays) append(array.bytes);
  return file;
}

}  // namespace sparse_mocap
