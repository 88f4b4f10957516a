// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

struct BuildOptions {
  double rate_hz = 25.0;
  bool add_mirrored = false;
  bool add_reversed = false;
  // Every motion is added once more at each of these tempos (readings recomputed): a small database
  // then knows more of how fast a movement can be done. Left out, with a warning, where it would
  // make the database larger than max_frames_with_copies.
  std::vector<double> tempo_copies{0.8, 1.25};
  int max_frames_with_copies = 200'000;
  std::vector<std::string> exclude;  // glob patterns (* ? [..]) on file names
  bool is_strict = false;            // stop at the first file that cannot be used
  ReadOptions read;
};

struct SkippedFile {
  std::filesystem::path path;
  std::string reason;
};

struct BuildReport {
  int num_files = 0;
  int num_clips = 0;
  int num_frames = 0;
  std::vector<SkippedFile> skipped;
  std::vector<std::string> warnings;
};

// Motion files in the folders (recursively) and files named, without those excluded, sorted.
// Throws FormatError when a source does not exist or nothing is left.
std::vector<std::filesystem::path> find_motion_files(
    const std::vector<std::filesystem::path>& sources, const std::vector<std::string>& exclude);

// Builds the knowledge base of Tautges et al. 2011, section 3, and writes it atomically to output.
// Throws FormatError (nothing usable, or is_strict), Cancelled; output is untouched then.
BuildReport build_database(const std::vector<std::filesystem::path>& sources,
                           const std::filesystem::path& output, const BuildOptions& options,
                           const Progress& progress = Progress());

// The rows of one clip: the motion, on a standard skeleton at its own rate, sampled at rate_hz.
DatabaseRows database_rows(const Motion& standard_motion, double rate_hz);

}  // namespace sparse_mocap
