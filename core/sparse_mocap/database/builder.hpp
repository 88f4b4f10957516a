// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/database/file_work.hpp"
#include "sparse_mocap/database/paired_take.hpp"
#include "sparse_mocap/formats/mapping_file.hpp"
#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

// What people say of a motion file and its name does not; what is empty is not said.
struct FileLabels {
  std::string actor, motion_class, origin, license;
  double rate_hz = 0.0;  // in which it was recorded, whatever the file says; 0: not said
};

// How files get into a database.
struct ImportOptions {
  std::vector<std::string> exclude;  // glob patterns (* ? [..]) on file names
  bool is_strict = false;            // stop at the first file that cannot be used or is doubtful
  bool keep_duplicates = false;      // also take files whose motion is there already
  int num_threads = 0;               // 0: one a processor; the result is the same
  RemoteWork remote;                 // does the work on files instead; the result is the same
  std::map<std::filesystem::path, FileLabels> labels;  // by the paths of find_source_files
  std::vector<std::string> label_warnings;             // one line each, for the report
  MappingChoice mapping;                               // written by hand
  ReadOptions read;
  // What sensors recorded while files were performed, by their paths as well. Such a file is always
  // read, and takes the place of what it gave before.
  std::map<std::filesystem::path, PairedTake> takes;
};

struct BuildOptions : ImportOptions {
  double rate_hz = 25.0;
  bool add_mirrored = false;
  bool add_reversed = false;
  // Every motion is added once more at each of these tempos (readings recomputed): a small database
  // then knows more of how fast a movement can be done. Left out, with a warning, where it would
  // make the database larger than max_frames_with_copies.
  std::vector<double> tempo_copies{0.8, 1.25};
  int max_frames_with_copies = 200'000;
  // Whether the readings are those of each body's own proportions, not of the averaged ones that
  // its poses are shown on (Tautges et al. 2011, figure 10a).
  bool has_own_proportions = false;
};

struct SkippedFile {
  std::filesystem::path path;
  std::string reason;  // one line, with the path
};

struct BuildReport {
  int num_files = 0;     // taken in by this call
  int num_known = 0;     // in the database already, not read again
  int num_replaced = 0;  // of num_files: took the place of what the file held before
  int num_clips = 0;     // of the database written
  int num_frames = 0;
  std::uint64_t source_frames = 0;  // of the files taken in
  std::uint64_t source_bytes = 0;
  double elapsed_s = 0.0;
  std::vector<SkippedFile> skipped;     // cannot be used
  std::vector<SkippedFile> duplicates;  // hold a motion that is there already
  std::vector<SkippedFile> doubtful;    // taken in, but see why; the worst first
  std::vector<std::string> warnings;
};

// Builds the knowledge base of Tautges et al. 2011, section 3, and writes it atomically to output.
// The file depends on the sources and options alone, not on the number of threads.
// Throws FormatError (nothing usable, or is_strict), ConfigError, Cancelled; output is untouched
// then.
BuildReport build_database(const std::vector<std::filesystem::path>& sources,
                           const std::filesystem::path& output, const BuildOptions& options,
                           const Progress& progress = Progress());

// Adds files to a database: on its own skeleton, at its own rate and with its own kinds of copies.
// Rows that are there stay as they are; a file that is in already (by its hash) is not read; one
// that changed since takes the place of its old clips. Several at once wait for one another. A
// warning says how far the averaged skeleton would change with the bodies added. Errors as above.
BuildReport add_to_database(const std::filesystem::path& database,
                            const std::vector<std::filesystem::path>& sources,
                            const std::filesystem::path& output, const ImportOptions& options,
                            const Progress& progress = Progress());

// Builds a database anew from its own files and others, all of which the sources must hold: the
// skeleton is averaged over all bodies. Rate, copies, readings of real sensors, and labels that the
// new ones do not replace stay. Errors as above; FormatError too when a file of the database is not
// among the sources.
BuildReport rebuild_database(const std::filesystem::path& database,
                             const std::vector<std::filesystem::path>& sources,
                             const std::filesystem::path& output, const ImportOptions& options,
                             const Progress& progress = Progress());

// Drops the clips, copies too, whose name, source or source's file name matches one of the glob
// patterns. Gives how many were dropped. Throws FormatError when a pattern matches nothing or
// nothing would be left; output is untouched then.
int drop_from_database(const std::filesystem::path& database,
                       const std::vector<std::string>& patterns,
                       const std::filesystem::path& output);

}  // namespace sparse_mocap
