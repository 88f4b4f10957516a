// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/builder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "sparse_mocap/base/file_lock.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/database/clip_names.hpp"
#include "sparse_mocap/database/importer.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMostThreads = 1024;

void check(const ImportOptions& options) {
  if (options.num_threads < 0 || options.num_threads > kMostThreads)
    throw ConfigError("the number of threads must be between 0 (one a processor) and " +
                      std::to_string(kMostThreads) + ", got " +
                      std::to_string(options.num_threads));
}

void check_copies(double rate_hz, const std::vector<double>& tempos) {
  if (!(rate_hz >= 1.0 && rate_hz <= 1000.0))
    throw ConfigError("the frame rate must be between 1 and 1000 Hz, got " +
                      std::to_string(rate_hz));
  for (const double tempo : tempos)
    if (!(tempo >= 0.25 && tempo <= 4.0))
      throw ConfigError("a tempo must be between 0.25 and 4, got " + std::to_string(tempo));
}

// A slip of the shell or of a file dialog must not cost somebody a recording.
void check_output(const fs::path& output) {
  if (is_motion_file(output))
    throw FormatError({output}, "is the name of a motion file", "name the database NAME.smdb");
}

// Held while a database is read, changed and replaced. Waiting can be cancelled.
FileLock locked(const fs::path& database, const Progress& progress) {
  return FileLock(database,
                  [&] { progress.report(0, 0, "waiting for another program to finish"); });
}

// The copies to make: those at other tempos only as long as the database stays small.
CopyOptions copies_of(const BuildOptions& options, double source_seconds, BuildReport& report) {
  CopyOptions copies{
      options.rate_hz, options.add_mirrored, options.add_reversed, {}, options.has_own_proportions};
  double frames = source_seconds * options.rate_hz;
  frames *= (options.add_mirrored ? 2.0 : 1.0) * (options.add_reversed ? 2.0 : 1.0);
  double with_copies = frames;
  for (const double tempo : options.tempo_copies) with_copies += frames / tempo;
  if (with_copies <= options.max_frames_with_copies) {
    copies.tempos = options.tempo_copies;
  } else if (!options.tempo_copies.empty()) {
    report.warnings.push_back("copies at other tempos are left out: they would make " +
                              std::to_string(std::lround(with_copies)) + " frames");
  }
  return copies;
}

// The copies that an opened database holds of each motion.
CopyOptions copies_in(const DatabaseContent& content, const fs::path& path) {
  CopyOptions copies;
  copies.rate_hz = content.rate_hz;
  try {
    const json info = json::parse(content.build_info);
    copies.add_mirrored = info.at("mirror").get<bool>();
    copies.add_reversed = info.at("reverse").get<bool>();
    copies.tempos = info.at("tempo_copies").get<std::vector<double>>();
    copies.has_own_proportions = info.value("own_proportions", false);
    check_copies(copies.rate_hz, copies.tempos);
  } catch (const json::exception&) {
    throw FormatError({path}, "does not say how it was built",
                      "build it again with 'sparse-mocap database build'");
  }
  return copies;
}

// Puts the counts that follow from the content over what is there.
std::string with_counts(json info, const DatabaseContent& content) {
  std::set<std::string> files;
  int warnings = 0;
  for (const Clip& clip : content.clips) {
    files.insert(clip.source);
    for (const auto& [kind, count] : clip.warnings) warnings += count;
  }
  info["software"] = "sparse_mocap " SPARSE_MOCAP_VERSION;
  info["files"] = files.size();
  info["skipped"] = content.sources.skipped.size();
  info["duplicates"] = content.sources.duplicates.size();
  info["warnings"] = warnings;
  return info.dump(-1, ' ', false, json::error_handler_t::replace);
}

// What the database remembers of files that it does not hold: paths as the sources' names.
std::vector<LeftOut> remembered(const std::vector<SkippedFile>& left_out,
                                const std::vector<SourceFile>& files) {
  std::vector<LeftOut> entries;
  for (const auto& one : left_out) {
    const auto at = std::find_if(files.begin(), files.end(),
                                 [&](const SourceFile& file) { return file.path == one.path; });
    const std::string path = one.path.string();
    const std::string rest =
        one.reason.starts_with(path) ? one.reason.substr(path.size()) : ": " + one.reason;
    entries.push_back({at->name, at->name + rest});
  }
  return entries;
}

void remember(const BuildReport& report, const std::vector<SourceFile>& files,
              SourceRecord& sources) {
  const auto was_tried = [&](const LeftOut& old) {
    return std::any_of(files.begin(), files.end(),
                       [&](const SourceFile& file) { return file.name == old.source; });
  };
  for (auto* list : {&sources.skipped, &sources.duplicates}) std::erase_if(*list, was_tried);
  for (auto& one : remembered(report.skipped, files)) sources.skipped.push_back(std::move(one));
  for (auto& one : remembered(report.duplicates, files))
    sources.duplicates.push_back(std::move(one));
}

[[noreturn]] void refuse_all(const Importer& importer, const BuildReport& report) {
  const auto& files = importer.files();
  throw FormatError({files.front().path.parent_path()},
                    "none of " + std::to_string(files.size()) + " motion files can be used",
                    "first reason: " + report.skipped.front().reason);
}

BuildReport finished(Importer& importer, DatabaseContent& content, const json& info,
                     const fs::path& output, std::chrono::steady_clock::time_point start) {
  BuildReport report = std::move(importer.report());
  if (report.num_files == 0 && report.num_known == 0 && report.duplicates.empty())
    refuse_all(importer, report);
  remember(report, importer.files(), content.sources);
  content.build_info = with_counts(info, content);
  remove_abandoned_temporaries(output);
  write_database(output, content);
  report.num_clips = static_cast<int>(content.clips.size());
  for (const auto& rows : content.clip_rows) report.num_frames += rows.num_frames();
  report.elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

bool matches(const Clip& clip, const std::string& pattern) {
  return matches_glob(pattern, clip.name) || matches_glob(pattern, clip.source) ||
         matches_glob(pattern, fs::path(clip.source).filename().string());
}

// How far the joints of a database's skeleton would move in rest, m, were it averaged with further
// bodies.
double averaging_change_m(const Skeleton& skeleton, double num_bodies,
                          const std::vector<StandardBones>& further) {
  const StandardBones held = bones_of(skeleton), other = averaged_bones(further);
  const double weight = static_cast<double>(further.size());
  StandardBones averaged;
  for (std::size_t j = 0; j < averaged.size(); ++j)
    averaged[j] = (num_bodies * held[j] + weight * other[j]) / (num_bodies + weight);
  const auto before = rest_pose(skeleton), after = rest_pose(make_standard_skeleton(averaged));
  double change = 0.0;
  for (std::size_t j = 0; j < averaged.size(); ++j)
    change = std::max(change, (after.end[j] - before.end[j]).norm());
  return change;
}

void warn_about_new_bodies(const Importer& importer, const DatabaseContent& content,
                           const json& info, std::vector<std::string>& warnings) {
  constexpr double kWorthSaying_m = 1e-3;
  const auto& bodies = importer.new_bodies();
  if (bodies.empty()) return;
  const double num_bodies = std::max(1.0, info.value("bodies", 1.0));
  const double change = averaging_change_m(content.skeleton, num_bodies, bodies);
  if (change < kWorthSaying_m) return;
  warnings.push_back(
      "the proportions of " + std::to_string(bodies.size()) +
      " new bodies would change the database's averaged skeleton by up to " +
      std::to_string(std::lround(1e3 * change)) +
      " mm; 'database add --rebuild' with the folders of all files averages it anew");
}

// Puts what was said of the clips before over what their files' names say, not over new labels.
void keep_labels(const DatabaseContent& old, const Importer& importer, const ImportOptions& options,
                 DatabaseContent& content) {
  std::map<SourceHashes, const Clip*> known;
  for (const Clip& clip : old.clips)
    known.emplace(SourceHashes{clip.source_hash, clip.skeleton_hash}, &clip);
  std::set<std::string> labelled;
  for (const auto& file : importer.files())
    if (options.labels.contains(file.path)) labelled.insert(file.name);
  for (Clip& clip : content.clips) {
    const auto at = known.find({clip.source_hash, clip.skeleton_hash});
    if (at == known.end() || labelled.contains(clip.source)) continue;
    clip.actor = at->second->actor;
    clip.motion_class = at->second->motion_class;
    clip.origin = at->second->origin;
    clip.license = at->second->license;
  }
}

// Real readings depend on no skeleton: puts those that the old database's clips had into the same
// clips of the new one.
void keep_real_readings(const DatabaseContent& old, DatabaseContent& content) {
  const auto is_same = [](const Clip& a, const Clip& b) {
    return a.source_hash == b.source_hash && a.skeleton_hash == b.skeleton_hash &&
           a.is_mirrored == b.is_mirrored && a.is_reversed == b.is_reversed && a.tempo == b.tempo;
  };
  if (old.site_names != content.site_names) return;
  for (std::size_t c = 0; c < content.clips.size(); ++c) {
    Clip& clip = content.clips[c];
    const auto at = std::find_if(old.clips.begin(), old.clips.end(), [&](const Clip& known) {
      return known.take && is_same(known, clip);
    });
    if (at == old.clips.end() || clip.take) continue;
    const PackedRows& rows = old.clip_rows[static_cast<std::size_t>(at - old.clips.begin())];
    if (rows.num_frames() != content.clip_rows[c].num_frames()) continue;
    clip.take = at->take;
    keep_real_readings(*clip.take, rows, content.clip_rows[c]);
  }
}

json build_info(const CopyOptions& copies, const ImportOptions& options, std::size_t num_bodies) {
  json info{{"mirror", copies.add_mirrored},
            {"reverse", copies.add_reversed},
            {"tempo_copies", copies.tempos},
            {"exclude", options.exclude},
            {"bodies", num_bodies}};
  if (copies.has_own_proportions) info["own_proportions"] = true;
  return info;
}

}  // namespace

BuildReport build_database(const std::vector<fs::path>& sources, const fs::path& output,
                           const BuildOptions& options, const Progress& progress) {
  check(options);
  check_copies(options.rate_hz, options.tempo_copies);
  check_output(output);
  const auto start = std::chrono::steady_clock::now();
  Importer importer(sources, options, progress);
  const auto bodies = importer.survey();
  if (bodies.empty()) refuse_all(importer, importer.report());
  DatabaseContent content;
  content.skeleton = make_standard_skeleton(averaged_bones(bodies));
  content.rate_hz = options.rate_hz;
  const CopyOptions copies = copies_of(options, importer.num_source_seconds(), importer.report());
  importer.import(content, copies);
  return finished(importer, content, build_info(copies, options, bodies.size()), output, start);
}

BuildReport add_to_database(const fs::path& database, const std::vector<fs::path>& sources,
                            const fs::path& output, const ImportOptions& options,
                            const Progress& progress) {
  check(options);
  check_output(output);
  const auto start = std::chrono::steady_clock::now();
  const FileLock lock = locked(database, progress);
  DatabaseContent content = database_content(*MotionDatabase::open(database));
  if (content.site_names != all_site_names())
    throw FormatError({database}, "holds the readings of other sensor sites",
                      "build it again with 'sparse-mocap database build'");
  const CopyOptions copies = copies_in(content, database);
  Importer importer(sources, options, progress);
  importer.recognise(content);
  importer.import(content, copies);
  const json info = json::parse(content.build_info);
  warn_about_new_bodies(importer, content, info, importer.report().warnings);
  return finished(importer, content, info, output, start);
}

BuildReport rebuild_database(const fs::path& database, const std::vector<fs::path>& sources,
                             const fs::path& output, const ImportOptions& options,
                             const Progress& progress) {
  check(options);
  check_output(output);
  const auto start = std::chrono::steady_clock::now();
  const FileLock lock = locked(database, progress);
  const DatabaseContent old = database_content(*MotionDatabase::open(database));
  const CopyOptions copies = copies_in(old, database);
  Importer importer(sources, options, progress);
  const auto bodies = importer.survey();
  if (const std::string missing = importer.first_missing(old); !missing.empty())
    throw FormatError({database}, "holds '" + missing + "', which is not among the sources",
                      "name the folders of all its files, or drop that clip first");
  DatabaseContent content;
  content.skeleton = make_standard_skeleton(averaged_bones(bodies));
  content.rate_hz = copies.rate_hz;
  importer.import(content, copies);
  keep_labels(old, importer, options, content);
  keep_real_readings(old, content);
  if (!old.further.tensors.empty())
    importer.report().warnings.push_back(
        "the models in the database are left out, since they belong to its old skeleton; train "
        "them again");
  return finished(importer, content, build_info(copies, options, bodies.size()), output, start);
}

int drop_from_database(const fs::path& database, const std::vector<std::string>& patterns,
                       const fs::path& output) {
  check_output(output);
  const FileLock lock(database);
  DatabaseContent content = database_content(*MotionDatabase::open(database));
  for (const auto& pattern : patterns)
    if (std::none_of(content.clips.begin(), content.clips.end(),
                     [&](const Clip& clip) { return matches(clip, pattern); }))
      throw FormatError({database}, "no clip matches '" + pattern + "'",
                        "'sparse-mocap database info --json' lists the clips");
  const std::size_t num_before = content.clips.size();
  remove_clips(content, [&](std::size_t c) {
    return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
      return matches(content.clips[c], pattern);
    });
  });
  if (content.clips.empty())
    throw FormatError({database}, "every clip would be dropped", "delete the file instead");
  json info = json::parse(content.build_info, nullptr, false);
  content.build_info = with_counts(info.is_object() ? info : json::object(), content);
  remove_abandoned_temporaries(output);
  write_database(output, content);
  return static_cast<int>(num_before - content.clips.size());
}

}  // namespace sparse_mocap
