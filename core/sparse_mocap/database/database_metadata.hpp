// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// What the metadata of a database file say, as JSON texts.
struct DatabaseMetadata {
  Skeleton skeleton;
  double rate_hz = 25.0;
  std::vector<Clip> clips;
  SourceRecord sources;
  std::vector<std::string> site_names;
  std::string build_info;  // JSON
};

// Checks every claim that can be checked without the rows: the clips follow one another from row 0.
// Throws FormatError.
DatabaseMetadata read_database_metadata(const Container& container);

std::map<std::string, std::string> text_of(const DatabaseMetadata& metadata);

// The keys that text_of gives.
const std::set<std::string>& database_metadata_keys();

}  // namespace sparse_mocap
