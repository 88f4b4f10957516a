// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/database_content.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;
using Rows = DatabaseRows::Rows;

// File names need not be UTF-8; what is not is replaced, so that the header is sound JSON.
std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json skeleton_json(const Skeleton& skeleton) {
  json joints = json::array();
  for (const auto& joint : skeleton.joints())
    joints.push_back({{"name", joint.name}, {"bone_m", vector_json(joint.bone)}});
  return joints;
}

json clip_json(const Clip& clip, int begin, int end) {
  json entry{{"name", clip.name},
             {"actor", clip.actor},
             {"class", clip.motion_class},
             {"source", clip.source},
             {"source_hash", clip.source_hash},
             {"mirrored", clip.is_mirrored},
             {"reversed", clip.is_reversed},
             {"tempo", clip.tempo},
             {"begin", begin},
             {"end", end},
             {"source_frames", clip.source_frames},
             {"source_rate_hz", clip.source_rate_hz}};
  const auto put = [&](const char* key, const std::string& value) {
    if (!value.empty()) entry[key] = value;
  };
  put("skeleton", clip.skeleton);
  put("skeleton_hash", clip.skeleton_hash);
  put("origin", clip.origin);
  put("license", clip.license);
  if (!clip.warnings.empty()) entry["warnings"] = clip.warnings;
  return entry;
}

json clips_json(const DatabaseContent& content) {
  json clips = json::array();
  int begin = 0;
  for (std::size_t c = 0; c < content.clips.size(); ++c) {
    const int end = begin + content.clip_rows[c].num_frames();
    clips.push_back(clip_json(content.clips[c], begin, end));
    begin = end;
  }
  return clips;
}

json left_out_json(const std::vector<LeftOut>& files) {
  json entries = json::array();
  for (const auto& file : files)
    entries.push_back({{"source", file.source}, {"reason", file.reason}});
  return entries;
}

json sources_json(const SourceRecord& sources) {
  json skeletons = json::array();
  for (const auto& skeleton : sources.skeletons)
    skeletons.push_back({{"id", skeleton.id},
                         {"num_joints", skeleton.num_joints},
                         {"joints", skeleton.joints},
                         {"unit_scale", skeleton.unit_scale}});
  return {{"skeletons", skeletons},
          {"skipped", left_out_json(sources.skipped)},
          {"duplicates", left_out_json(sources.duplicates)}};
}

using Piece = std::span<const std::byte>;

ArrayInPieces gathered(const char* name, const DatabaseContent& content,
                       Rows DatabaseRows::*member) {
  ArrayInPieces array{{name, ElementType::f32, {0, 0}, {}}, {}};
  for (const auto& rows : content.clip_rows) {
    const Rows& part = rows.*member;
    array.tensor.shape[0] += static_cast<std::size_t>(part.rows());
    array.tensor.shape[1] = static_cast<std::size_t>(part.cols());
    array.pieces.push_back(
        std::as_bytes(std::span(part.data(), static_cast<std::size_t>(part.size()))));
  }
  return array;
}

std::vector<std::int32_t> clip_indices(const DatabaseContent& content) {
  std::vector<std::int32_t> indices;
  for (std::size_t c = 0; c < content.clip_rows.size(); ++c)
    indices.insert(indices.end(), static_cast<std::size_t>(content.clip_rows[c].num_frames()),
                   static_cast<std::int32_t>(c));
  return indices;
}

std::map<std::string, std::string> metadata_of(const DatabaseContent& content) {
  std::map<std::string, std::string> metadata = content.further.metadata;
  metadata["rate_hz"] = json(content.rate_hz).dump();
  metadata["filter"] = json{{"kind", "gaussian"},
                            {"marker_sigma_s", kMarkerFilter.sigma_s},
                            {"reading_sigma_s", kReadingFilter.sigma_s}}
                           .dump();
  metadata["skeleton"] = skeleton_json(content.skeleton).dump();
  metadata["sites"] = dumped(content.site_names);
  metadata["clips"] = dumped(clips_json(content));
  metadata["sources"] = dumped(sources_json(content.sources));
  metadata["build"] = content.build_info;
  return metadata;
}

std::vector<ArrayInPieces> all_arrays(const DatabaseContent& content,
                                      const std::vector<std::int32_t>& indices) {
  std::vector<ArrayInPieces> arrays{
      gathered("angles", content, &DatabaseRows::angles),
      gathered("positions", content, &DatabaseRows::positions),
      gathered("root_motion", content, &DatabaseRows::root_motion),
      gathered("contacts", content, &DatabaseRows::contacts),
      gathered("specific_force_pivot", content, &DatabaseRows::specific_force_pivot),
      gathered("specific_force_end", content, &DatabaseRows::specific_force_end),
      gathered("angular_velocity", content, &DatabaseRows::angular_velocity),
      gathered("up", content, &DatabaseRows::gravity_direction),
      {{"clip_index", ElementType::i32, {indices.size(), 1}, {}},
       {std::as_bytes(std::span(indices))}}};
  for (const auto& tensor : content.further.tensors) arrays.push_back({tensor, {tensor.bytes}});
  return arrays;
}

// A file in pieces that view the content and what is kept here.
class EncodedDatabase {
 public:
  explicit EncodedDatabase(const DatabaseContent& content)
      : indices_(clip_indices(content)),
        container_(kDatabaseFormat, metadata_of(content), all_arrays(content, indices_)) {}

  const EncodedContainer& container() const { return container_; }

 private:
  std::vector<std::int32_t> indices_;
  EncodedContainer container_;
};

void check(const DatabaseContent& content) {
  if (content.clips.empty() || content.clips.size() != content.clip_rows.size())
    throw std::invalid_argument("a database's clips and their rows do not correspond");
}

}  // namespace

DatabaseContent database_content(const MotionDatabase& database) {
  DatabaseContent content{
      database.skeleton(), database.rate_hz(),    database.clips(),      {},
      database.sources(),  database.build_info(), database.site_names(), database.further(),
      database.bytes()};
  for (const Clip& clip : database.clips()) {
    const auto of_clip = [&](const FloatRows& rows) {
      return Rows(rows.middleRows(clip.begin, clip.num_frames()));
    };
    content.clip_rows.push_back(
        {of_clip(database.angles()), of_clip(database.positions()), of_clip(database.root_motion()),
         of_clip(database.contacts()), of_clip(database.specific_force_pivot()),
         of_clip(database.specific_force_end()), of_clip(database.angular_velocity()),
         of_clip(database.gravity_direction())});
  }
  return content;
}

void remove_clips(DatabaseContent& content,
                  const std::function<bool(std::size_t clip)>& is_unwanted) {
  std::vector<Clip> clips;
  std::vector<DatabaseRows> clip_rows;
  std::set<std::string> skeletons;
  for (std::size_t c = 0; c < content.clips.size(); ++c) {
    if (is_unwanted(c)) continue;
    skeletons.insert(content.clips[c].skeleton);
    clip_rows.push_back(std::move(content.clip_rows[c]));
    clips.push_back(content.clips[c]);
  }
  content.clips = std::move(clips);
  content.clip_rows = std::move(clip_rows);
  std::erase_if(content.sources.skeletons,
                [&](const SourceSkeleton& known) { return !skeletons.contains(known.id); });
}

std::vector<std::byte> encode_database(const DatabaseContent& content) {
  check(content);
  return EncodedDatabase(content).container().bytes();
}

void write_database(const std::filesystem::path& path, const DatabaseContent& content) {
  check(content);
  EncodedDatabase(content).container().write(path);
}

std::vector<std::string> all_site_names() {
  std::vector<std::string> names;
  for (const auto& site : all_sites()) names.emplace_back(site.name);
  return names;
}

}  // namespace sparse_mocap
