// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/database_content.hpp"

#include <algorithm>
#include <cstdint>
#include <list>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_metadata.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/sections.hpp"

namespace sparse_mocap {
namespace {

template <typename Matrix>
std::span<const std::byte> bytes_of(const Matrix& rows) {
  return std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(rows.size())));
}

// The database's own arrays, in pieces that view the content and what is kept here, in the order in
// which MotionDatabase::rows_hash takes their checksums.
class Arrays {
 public:
  explicit Arrays(const DatabaseContent& content) : content_(content) {
    add_packed("angles", [](const PackedRows& rows) { return &rows.angles; });
    add_packed("positions", [](const PackedRows& rows) { return &rows.positions; });
    add("root_motion", [](const PackedRows& rows) { return &rows.root_motion; });
    add("contacts", [](const PackedRows& rows) { return &rows.contacts; });
    if (std::any_of(content.clips.begin(), content.clips.end(), has_any_extremity))
      add_packed("extremities", [](const PackedRows& rows) { return &rows.extremities; });
    for (std::size_t s = 0; s < content.site_names.size(); ++s) {
      const auto add_of_site = [&](const char* name, PackedArray PackedSite::*member) {
        add_packed(site_array(content.site_names[s], name),
                   [&](const PackedRows& rows) { return &(rows.sites.at(s).*member); });
      };
      add_of_site("specific_force_pivot", &PackedSite::specific_force_pivot);
      add_of_site("specific_force_end", &PackedSite::specific_force_end);
      add_of_site("angular_velocity", &PackedSite::angular_velocity);
      add_of_site("up", &PackedSite::gravity_direction);
      if (has_real_orientation(content.clips, content.site_names[s])) add_orientation(s);
    }
  }

  const std::vector<ArrayInPieces>& arrays() const { return arrays_; }

 private:
  template <typename RowsOf>
  void add(const std::string& name, const RowsOf& rows_of) {
    using Scalar = std::remove_cvref_t<decltype(*rows_of(content_.clip_rows[0])->data())>;
    ArrayInPieces array{{name, kElementTypeOf<Scalar>, {0, 0}, {}}, {}};
    for (const auto& rows : content_.clip_rows) {
      const auto& part = *rows_of(rows);
      array.tensor.shape[0] += static_cast<std::size_t>(part.rows());
      array.tensor.shape[1] = static_cast<std::size_t>(part.cols());
      array.pieces.push_back(bytes_of(part));
    }
    arrays_.push_back(std::move(array));
  }

  template <typename ArrayOf>
  void add_packed(const std::string& name, const ArrayOf& array_of) {
    add(name, [&](const PackedRows& rows) { return &array_of(rows)->values; });
    std::vector<float>& scales = scales_.emplace_back();
    for (const auto& rows : content_.clip_rows) scales.push_back(array_of(rows)->scale);
    arrays_.push_back({{scale_name(name), ElementType::f32, {scales.size(), 1}, {}},
                       {std::as_bytes(std::span(scales))}});
  }

  // Zero in clips whose takes do not tell it.
  void add_orientation(std::size_t site) {
    for (const auto& rows : content_.clip_rows)
      if (nothing_.rows() < rows.num_frames()) nothing_.setZero(rows.num_frames(), 4);
    ArrayInPieces array{{site_array(content_.site_names[site], "orientation"),
                         kElementTypeOf<std::int16_t>,
                         {0, 4},
                         {}},
                        {}};
    std::vector<float>& scales = scales_.emplace_back();
    for (const auto& rows : content_.clip_rows) {
      const PackedArray& part = rows.sites.at(site).orientation;
      const auto num_frames = static_cast<std::size_t>(rows.num_frames());
      const bool is_told = part.values.rows() == rows.num_frames();
      array.tensor.shape[0] += num_frames;
      array.pieces.push_back(is_told ? bytes_of(part.values)
                                     : std::as_bytes(std::span(nothing_.data(), 4 * num_frames)));
      scales.push_back(is_told ? part.scale : 1.0F);
    }
    const std::string scale = scale_name(array.tensor.name);
    arrays_.push_back(std::move(array));
    arrays_.push_back(
        {{scale, ElementType::f32, {scales.size(), 1}, {}}, {std::as_bytes(std::span(scales))}});
  }

  const DatabaseContent& content_;
  decltype(PackedArray::values) nothing_;
  std::list<std::vector<float>> scales_;
  std::vector<ArrayInPieces> arrays_;
};

std::map<std::string, std::string> own_metadata(const DatabaseContent& content) {
  DatabaseMetadata metadata{content.skeleton, content.rate_hz,    content.clips,
                            content.sources,  content.site_names, content.build_info};
  int begin = 0;
  for (std::size_t c = 0; c < metadata.clips.size(); ++c) {
    metadata.clips[c].begin = begin;
    metadata.clips[c].end = begin += content.clip_rows[c].num_frames();
  }
  return text_of(metadata);
}

// As MotionDatabase::rows_hash.
std::string rows_hash(const std::map<std::string, std::string>& metadata,
                      const std::vector<ArrayInPieces>& arrays) {
  std::string all;
  for (const auto& array : arrays) all += checksum_of_pieces(array.pieces);
  for (const char* key : {"skeleton", "clips", "rate_hz"}) all += metadata.at(key);
  return checksum(std::as_bytes(std::span(all)));
}

void check(const DatabaseContent& content) {
  if (content.clips.empty() || content.clips.size() != content.clip_rows.size())
    throw std::invalid_argument("a database's clips and their rows do not correspond");
  for (const auto& rows : content.clip_rows)
    if (rows.sites.size() != content.site_names.size())
      throw std::invalid_argument("a database's rows do not correspond to its sites");
}

// A file in pieces that view the content and what is kept here.
class EncodedDatabase {
 public:
  explicit EncodedDatabase(const DatabaseContent& content)
      : arrays_(content), container_(encoded(content, arrays_.arrays())) {}

  const EncodedContainer& container() const { return container_; }

 private:
  static EncodedContainer encoded(const DatabaseContent& content,
                                  std::vector<ArrayInPieces> arrays) {
    auto metadata = own_metadata(content);
    SafetensorsView further = content.further;
    remove_stale_sections(further, rows_hash(metadata, arrays));
    metadata.merge(further.metadata);
    for (const auto& tensor : further.tensors) arrays.push_back({tensor, {tensor.bytes}});
    return {kDatabaseFormat, std::move(metadata), std::move(arrays)};
  }

  Arrays arrays_;
  EncodedContainer container_;
};

PackedArray packed_rows_of(const ScaledRows& rows, const Clip& clip) {
  return {rows.values().middleRows(clip.begin, clip.num_frames()), rows.scale(clip.begin)};
}

PackedArray extremity_rows_of(const MotionDatabase& database, const Clip& clip) {
  if (database.extremities().rows() > 0) return packed_rows_of(database.extremities(), clip);
  return packed(DatabaseRows::Rows(
      DatabaseRows::Rows::Zero(clip.num_frames(), Eigen::Index{3 * kNumExtremities})));
}

PackedRows packed_rows_of(const MotionDatabase& database, const Clip& clip) {
  PackedRows rows{packed_rows_of(database.angles(), clip),
                  packed_rows_of(database.positions(), clip),
                  extremity_rows_of(database, clip),
                  database.root_motion().middleRows(clip.begin, clip.num_frames()),
                  database.contacts().middleRows(clip.begin, clip.num_frames()),
                  {}};
  for (std::size_t s = 0; s < database.site_names().size(); ++s) {
    const SiteRows& site = database.site(s);
    rows.sites.push_back({packed_rows_of(site.specific_force_pivot, clip),
                          packed_rows_of(site.specific_force_end, clip),
                          packed_rows_of(site.angular_velocity, clip),
                          packed_rows_of(site.gravity_direction, clip)});
    if (is_real(clip, database.site_names()[s], Channel::orientation))
      rows.sites.back().orientation = packed_rows_of(site.orientation, clip);
  }
  return rows;
}

}  // namespace

std::string scale_name(const std::string& array) { return array + "/scale"; }

std::string site_array(const std::string& site, const std::string& name) {
  return "sites/" + site + "/" + name;
}

DatabaseContent database_content(const MotionDatabase& database) {
  DatabaseContent content{
      database.skeleton(), database.rate_hz(),    database.clips(),      {},
      database.sources(),  database.build_info(), database.site_names(), database.further(),
      database.bytes()};
  for (const Clip& clip : database.clips())
    content.clip_rows.push_back(packed_rows_of(database, clip));
  return content;
}

void remove_clips(DatabaseContent& content,
                  const std::function<bool(std::size_t clip)>& is_unwanted) {
  std::vector<Clip> clips;
  std::vector<PackedRows> clip_rows;
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
