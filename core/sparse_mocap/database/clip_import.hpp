// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/clip_check.hpp"
#include "sparse_mocap/database/packed_rows.hpp"
#include "sparse_mocap/database/source_files.hpp"
#include "sparse_mocap/formats/mapping_file.hpp"
#include "sparse_mocap/formats/motion_file.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// The work on one motion file: it knows no other file, so any thread may do it.

// What came of a file, or what is wrong with it.
template <typename Result>
using Outcome = std::variant<Result, FormatError>;

// What a file says before a database's skeleton is known.
struct SurveyedFile {
  SourceHashes hashes;
  StandardBones bones;  // m
  int num_frames = 0;
  double duration_s = 0.0;
};

// A file on a database's skeleton.
struct ImportedFile {
  std::vector<Clip> clips;  // the motion itself first, then its copies
  std::vector<PackedRows> clip_rows;
  SourceSkeleton skeleton;
  StandardBones bones;                // the body's own, m
  std::vector<std::string> warnings;  // one line each
  std::vector<ClipFault> faults;      // the worst first; none that is refused
};

// Which copies a database holds beside each motion, and at what rate.
struct CopyOptions {
  double rate_hz = 25.0;
  bool add_mirrored = false;
  bool add_reversed = false;
  std::vector<double> tempos;
  bool has_own_proportions = false;  // readings are of each body's own, not the averaged ones
};

// What is asked about a file before a database's skeleton is known.
struct SurveyRequest {
  SourceFile file;
  ReadOptions read;
  MappingChoice mapping;
};

// And when it is.
struct ImportRequest : SurveyRequest {
  SourceHashes hashes;
  StandardBones bones;  // of the database's skeleton
  CopyOptions copies;
  bool is_strict = false;  // any fault of a clip refuses it
};

// Both throw Cancelled soon after stop is requested.
Outcome<SurveyedFile> survey_file(const SurveyRequest& request, const std::stop_token& stop);
Outcome<ImportedFile> import_file(const ImportRequest& request, const std::stop_token& stop);

// A warning without what differs from file to file: numbers become '#', quoted names '...'.
std::string kind_of_warning(const std::string& warning);

}  // namespace sparse_mocap
