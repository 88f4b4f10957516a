// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

// A motion file among the sources of a database.
struct SourceFile {
  std::filesystem::path path;
  std::string name;  // relative to the source folder that it was found in, with '/'
  std::uintmax_t num_bytes = 0;
};

// Motion files in the folders (recursively) and files named, without those whose file name matches
// one of the glob patterns (* ? [..]), sorted by path. Where two folders hold files of the same
// relative name, the names begin with the folders' own.
// Throws FormatError when a source does not exist or nothing is left.
std::vector<SourceFile> find_source_files(const std::vector<std::filesystem::path>& sources,
                                          const std::vector<std::string>& exclude,
                                          const ReadOptions& options = {});

// One line on the files of other formats in the folders, by kind and with what to do about them;
// empty where there are none.
std::string other_formats_in(const std::vector<std::filesystem::path>& sources,
                             const ReadOptions& options);

// XXH3 of a file, 16 hexadecimal digits. Throws FormatError when it cannot be read.
std::string hash_of_file(const std::filesystem::path& path);

// What a clip's rows depend on: the hash of the file, and of the .asf that is read with an .amc
// ("" for other formats). Throws FormatError.
struct SourceHashes {
  std::string file;
  std::string skeleton;

  auto operator<=>(const SourceHashes&) const = default;
};
SourceHashes hashes_of(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace sparse_mocap
