// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/source_files.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/database/clip_names.hpp"
#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/motion_file.hpp"
#include "sparse_mocap/formats/other_formats.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

// A path as it was named, and the folder that its name is relative to.
struct Found {
  fs::path path;
  fs::path folder;
};

std::string known_endings(const ReadOptions& options) {
  std::string endings = ".bvh, .amc";
  for (const auto& [ending, reader] : options.further_readers) endings += ", " + ending;
  return endings;
}

std::vector<Found> found_in(const fs::path& source, const ReadOptions& options) {
  if (!fs::exists(source)) throw FormatError({source}, "no such file or folder", "check the path");
  if (!fs::is_directory(source)) {
    if (const auto* other = other_format_by_ending(source))
      throw FormatError({source}, other->what, other->remedy);
    if (!is_motion_file(source, options))
      throw FormatError({source}, "is no motion file (" + known_endings(options) + ")",
                        "name motion files or folders");
    return {{source, source.parent_path()}};
  }
  std::vector<Found> found;
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  for (const auto& entry : fs::recursive_directory_iterator(source, kSkip)) {
    std::error_code unreadable;
    if (entry.is_regular_file(unreadable) && is_motion_file(entry.path(), options))
      found.push_back({entry.path(), source});
  }
  return found;
}

bool is_excluded(const fs::path& path, const std::vector<std::string>& exclude) {
  const std::string name = path.filename().string();
  return std::any_of(exclude.begin(), exclude.end(),
                     [&](const std::string& pattern) { return matches_glob(pattern, name); });
}

// Sorted, each file once: where a folder and one in it are named, relative to the outer one.
void sort_and_unify(std::vector<Found>& found) {
  const auto key = [](const Found& f) { return std::pair(f.path, f.folder); };
  for (auto& f : found) f.path = f.path.lexically_normal();
  std::sort(found.begin(), found.end(),
            [&](const Found& a, const Found& b) { return key(a) < key(b); });
  const auto is_same = [](const Found& a, const Found& b) { return a.path == b.path; };
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());
}

std::string relative_name(const Found& found) {
  return found.path.lexically_relative(found.folder.lexically_normal()).generic_string();
}

// The folder's own name before the relative one; the whole path where that is no name either.
std::string longer_name(const Found& found) {
  const fs::path folder = fs::absolute(found.folder / ".").lexically_normal().parent_path();
  return (folder.filename() / relative_name(found)).generic_string();
}

void name_files(const std::vector<Found>& found, std::vector<SourceFile>& files) {
  const auto rename_repeated = [&](auto name_of) {
    std::map<std::string, int> counts;
    for (const auto& file : files) ++counts[file.name];
    for (std::size_t i = 0; i < files.size(); ++i)
      if (counts[files[i].name] > 1) files[i].name = name_of(found[i]);
  };
  for (std::size_t i = 0; i < files.size(); ++i) files[i].name = relative_name(found[i]);
  rename_repeated(longer_name);
  rename_repeated([](const Found& f) { return fs::absolute(f.path).generic_string(); });
}

}  // namespace

std::vector<SourceFile> find_source_files(const std::vector<fs::path>& sources,
                                          const std::vector<std::string>& exclude,
                                          const ReadOptions& options) {
  std::vector<Found> found;
  for (const auto& source : sources) {
    auto more = found_in(source, options);
    found.insert(found.end(), more.begin(), more.end());
  }
  if (found.empty()) {
    const std::string others = other_formats_in(sources, options);
    throw FormatError({sources.empty() ? fs::path() : sources.front()},
                      "holds no motion file (" + known_endings(options) + ")",
                      others.empty() ? "name a folder of motion capture" : others);
  }
  std::erase_if(found, [&](const Found& f) { return is_excluded(f.path, exclude); });
  if (found.empty())
    throw FormatError({sources.front()}, "every motion file is excluded", "exclude fewer");
  sort_and_unify(found);
  std::vector<SourceFile> files;
  for (const auto& f : found) {
    std::error_code unreadable;
    const auto size = fs::file_size(f.path, unreadable);
    files.push_back({f.path, "", unreadable ? 0 : size});
  }
  name_files(found, files);
  return files;
}

std::string hash_of_file(const fs::path& path) { return checksum(map_file(path)->view()); }

std::string other_formats_in(const std::vector<fs::path>& sources, const ReadOptions& options) {
  std::map<std::string, int> counts;
  std::map<std::string, std::string> remedy_of;  // by ending
  int total = 0;
  for (const auto& source : sources) {
    if (!fs::is_directory(source)) continue;
    constexpr auto kSkip = fs::directory_options::skip_permission_denied;
    for (const auto& entry : fs::recursive_directory_iterator(source, kSkip)) {
      std::error_code unreadable;
      const auto* other = other_format_by_ending(entry.path());
      if (other == nullptr || !entry.is_regular_file(unreadable)) continue;
      if (is_motion_file(entry.path(), options)) continue;
      ++total;
      ++counts[std::string(other->mark)];
      remedy_of[std::string(other->mark)] = other->remedy;
    }
  }
  if (total == 0) return "";
  std::string line = std::to_string(total) + " files of other formats were not read:";
  for (const auto& [ending, count] : counts) line += " " + std::to_string(count) + " " + ending;
  std::map<std::string, std::string> remedies;  // by what to do: the endings
  for (const auto& [ending, remedy] : remedy_of) {
    std::string& endings = remedies[remedy];
    endings += (endings.empty() ? "" : ", ") + ending;
  }
  for (const auto& [remedy, endings] : remedies) line += "; " + endings + ": " + remedy;
  return line;
}

SourceHashes hashes_of(const fs::path& path, const ReadOptions& options) {
  SourceHashes hashes{hash_of_file(path), ""};
  if (equal_ignoring_case(path.extension().string(), ".amc"))
    hashes.skeleton = hash_of_file(options.asf.empty() ? find_asf(path) : options.asf);
  return hashes;
}

}  // namespace sparse_mocap
