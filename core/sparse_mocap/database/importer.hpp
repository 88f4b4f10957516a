// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/clip_import.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/database/duplicates.hpp"

namespace sparse_mocap {

// Brings source files into a database's content, in two passes over the files: the first finds out
// which are needed (survey or recognise), the second imports these.
class Importer {
 public:
  // Throws FormatError when a source does not exist or holds nothing.
  Importer(const std::vector<std::filesystem::path>& sources, const ImportOptions& options,
           const Progress& progress);

  // First pass for a new database. Gives the bodies of all usable files, each once.
  std::vector<StandardBones> survey();
  // First pass for a database that is there: what it holds already is left out.
  void recognise(DatabaseContent& content);
  // Second pass.
  void import(DatabaseContent& content, const CopyOptions& copies);

  // After survey: the first file of a database that is not among the sources, "" when all are.
  std::string first_missing(const DatabaseContent& content) const;
  // After import: the bodies of actors that were not in the database before, each once.
  const std::vector<StandardBones>& new_bodies() const { return new_bodies_; }

  double num_source_seconds() const { return num_source_seconds_; }
  const std::vector<SourceFile>& files() const { return files_; }
  BuildReport& report() { return report_; }

 private:
  struct Pending {
    std::size_t file = 0;
    SourceHashes hashes;
  };

  void label(const SourceFile& file, Clip& clip) const;
  ReadOptions read_options(const SourceFile& file) const;
  SurveyRequest survey_request(std::size_t file) const;
  void begin_pass(std::size_t num_files, std::uint64_t num_bytes, std::size_t num_passes_left);
  void show(const SourceFile& file) const;
  void count(const SourceFile& file, int num_frames);
  void skip(const SourceFile& file, const FormatError& error);
  void leave_out(const SourceFile& file, const std::string& reason);
  bool is_repeated(std::size_t file, const SourceHashes& hashes);
  void know_clips(const DatabaseContent& content);
  void know_body(const std::string& actor, const StandardBones& bones);
  void keep_old_clips(const Pending& pending, const DatabaseContent& content);
  bool pair(const SourceFile& file, const DatabaseContent& content, ImportedFile& imported);
  void take_in(const SourceFile& file, ImportedFile imported, DatabaseContent& content);
  void sort_doubtful();
  void remove_replaced(DatabaseContent& content, std::size_t num_old_clips);

  const ImportOptions& options_;
  const Progress& progress_;
  MappingChoice mapping_;
  std::vector<SourceFile> files_;
  std::vector<Pending> pending_;
  std::map<SourceHashes, std::size_t> first_of_hash_;
  std::set<std::string> replaced_;  // sources whose old clips go, once the new ones are there
  DuplicateFinder finder_;
  std::vector<std::string> known_sources_;  // by the ids of finder_
  std::set<std::string> old_actors_;        // of the clips that were there before
  std::vector<StandardBones> new_bodies_;
  std::vector<double> severities_;  // of the report's doubtful files
  double num_source_seconds_ = 0.0;
  std::size_t done_before_ = 0;  // files of the passes before
  ProgressReport counts_;
  BuildReport report_;
};

}  // namespace sparse_mocap
