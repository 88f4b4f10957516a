// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/clip.hpp"
#include "sparse_mocap/database/source_files.hpp"

namespace sparse_mocap {

struct CsvField {
  std::string text;
  int column = 1;  // in bytes, where it starts
};

// What people say about motion files in a table beside them: UTF-8 CSV (fields that hold commas or
// quotes in quotes) with the header `file,actor,class,source,license`, any of these in any order,
// `file` needed. A file is named by its path in the source folder, its file name or its name
// without the ending, in any case; the longest that fits counts. What is left empty is not said.
class Sidecar {
 public:
  // Throws FormatError naming line and column, and the nearest column's name.
  static Sidecar read(const std::filesystem::path& path);

  // Puts what the table says of the file over what the clip says; whether it says anything.
  bool describe(const SourceFile& file, Clip& clip) const;

  // One line for each row that names none of the files.
  std::vector<std::string> warnings(const std::vector<SourceFile>& files) const;

 private:
  struct Row {
    int line = 0;
    std::string file;  // as written
    std::string actor, motion_class, origin, license;
  };

  const Row* find(const SourceFile& file) const;
  void add_row(const std::vector<std::string>& columns, const std::vector<CsvField>& fields,
               FileLocation where);

  std::filesystem::path path_;
  std::map<std::string, Row> rows_;  // by file, lower case
};

}  // namespace sparse_mocap
