// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/packed_rows.hpp"
#include "sparse_mocap/database/safetensors.hpp"
#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// The sites of which databases built now hold the readings.
std::vector<std::string> all_site_names();

// Everything that a database file holds, while it is being made.
struct DatabaseContent {
  Skeleton skeleton;
  double rate_hz = 25.0;
  std::vector<Clip> clips;            // begin and end are set on writing
  std::vector<PackedRows> clip_rows;  // one entry a clip
  SourceRecord sources;
  std::string build_info;  // JSON: options, counts, versions
  std::vector<std::string> site_names = all_site_names();
  // What else is to be in the file, see MotionDatabase::further, and the bytes that it views.
  SafetensorsView further;
  std::shared_ptr<const Bytes> further_bytes;
};

// How arrays are called in the file: the scales of one, and one of a site.
std::string scale_name(const std::string& array);
std::string site_array(const std::string& site, const std::string& name);

// The content of an opened database.
DatabaseContent database_content(const MotionDatabase& database);

// Removes the clips of which is_unwanted(index) tells so, and skeletons that no clip has then.
void remove_clips(DatabaseContent& content,
                  const std::function<bool(std::size_t clip)>& is_unwanted);

// The file as it will lie on disk, without sections that were made from other rows. Throws
// std::invalid_argument when clips and their rows do not correspond.
std::vector<std::byte> encode_database(const DatabaseContent& content);

// Writes it atomically, without a second copy of the rows. Throws as encode_database and
// std::filesystem_error.
void write_database(const std::filesystem::path& path, const DatabaseContent& content);

}  // namespace sparse_mocap
