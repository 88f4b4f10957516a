// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/importer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/database/clip_names.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

struct BodyKey {
  std::string actor;
  std::array<long, 3 * kNumStandardJoints> bones_um;
  auto operator<=>(const BodyKey&) const = default;
};

BodyKey body_key(const std::string& actor, const StandardBones& bones) {
  BodyKey key{actor, {}};
  for (std::size_t j = 0; j < bones.size(); ++j)
    for (int k = 0; k < 3; ++k)
      key.bones_um[3 * j + static_cast<std::size_t>(k)] = std::lround(1e6 * bones[j][k]);
  return key;
}

// Passes the outcome of each request to take, in their order, whoever does the work.
template <typename Request, typename Work, typename Decode, typename Take, typename Show>
void work_on_files(const ImportOptions& options, std::size_t count, const Request& request,
                   const Work& work, const Decode& decode, const Take& take, const Show& show) {
  if (!options.remote) {
    const auto here = [&](std::size_t i, const std::stop_token& stop) {
      return work(request(i), stop);
    };
    return work_in_order(count, options.num_threads, here, take, show);
  }
  std::vector<std::string> requests;
  for (std::size_t i = 0; i < count; ++i) requests.push_back(encoded(request(i)));
  const NextAnswer next = options.remote(std::move(requests));
  for (std::size_t i = 0; i < count; ++i) {
    std::optional<std::string> answer;
    do {
      show(i);
      answer = next();
    } while (!answer);
    take(i, decode(*answer));
  }
}

std::uint64_t sum_of_bytes(const std::vector<SourceFile>& files) {
  std::uint64_t sum = 0;
  for (const auto& file : files) sum += file.num_bytes;
  return sum;
}

}  // namespace

Importer::Importer(const std::vector<fs::path>& sources, const ImportOptions& options,
                   const Progress& progress)
    : options_(options),
      progress_(progress),
      mapping_(options.mapping),
      files_(find_source_files(sources, options.exclude, options.read)) {
  report_.warnings = options.label_warnings;
  if (auto others = other_formats_in(sources, options.read); !others.empty())
    report_.warnings.push_back(std::move(others));
  if (!options.remote || mapping_.remembered.empty()) return;
  mapping_.by_rig = remembered_mappings(mapping_.remembered);
  mapping_.remembered.clear();
}

// --- Labels --------------------------------------------------------------------------------------

// Puts what was said of the file over what its name says.
void Importer::label(const SourceFile& file, Clip& clip) const {
  const auto at = options_.labels.find(file.path);
  if (at == options_.labels.end()) return;
  const auto put = [](std::string& label, const std::string& said) {
    if (!said.empty()) label = said;
  };
  put(clip.actor, at->second.actor);
  put(clip.motion_class, at->second.motion_class);
  put(clip.origin, at->second.origin);
  put(clip.license, at->second.license);
}

ReadOptions Importer::read_options(const SourceFile& file) const {
  ReadOptions options = options_.read;
  options.refuse_other_asf = true;
  const auto at = options_.labels.find(file.path);
  if (at != options_.labels.end() && at->second.rate_hz > 0.0) options.rate_hz = at->second.rate_hz;
  return options;
}

SurveyRequest Importer::survey_request(std::size_t file) const {
  return {files_[file], read_options(files_[file]), mapping_};
}

// --- Progress and report -------------------------------------------------------------------------

void Importer::begin_pass(std::size_t num_files, std::uint64_t num_bytes,
                          std::size_t num_passes_left) {
  done_before_ += counts_.files;
  counts_.files = 0;
  counts_.frames = 0;
  counts_.num_files = num_files;
  counts_.total = done_before_ + num_passes_left * num_files;
  counts_.num_bytes = counts_.bytes + num_passes_left * num_bytes;
}

void Importer::show(const SourceFile& file) const {
  ProgressReport report = counts_;
  const std::string name = file.path.filename().string();
  report.done = done_before_ + counts_.files;
  report.what = name;
  progress_.report(report);
}

void Importer::count(const SourceFile& file, int num_frames) {
  ++counts_.files;
  counts_.bytes += file.num_bytes;
  counts_.frames += static_cast<std::uint64_t>(num_frames);
}

void Importer::skip(const SourceFile& file, const FormatError& error) {
  if (options_.is_strict) throw error;
  report_.skipped.push_back({file.path, error.what()});
}

void Importer::leave_out(const SourceFile& file, const std::string& reason) {
  report_.duplicates.push_back({file.path, FormatError({file.path}, reason).what()});
}

// --- First pass ----------------------------------------------------------------------------------

// Whether another file with this content came before; that is reported unless it is wanted.
bool Importer::is_repeated(std::size_t file, const SourceHashes& hashes) {
  const auto [first, is_new] = first_of_hash_.emplace(hashes, file);
  if (is_new || options_.keep_duplicates) return false;
  leave_out(files_[file], "the same file as " + files_[first->second].name);
  return true;
}

std::vector<StandardBones> Importer::survey() {
  std::set<BodyKey> seen;
  std::vector<StandardBones> bodies;
  begin_pass(files_.size(), sum_of_bytes(files_), 2);
  const auto take = [&](std::size_t i, const Outcome<SurveyedFile>& outcome) {
    const auto* surveyed = std::get_if<SurveyedFile>(&outcome);
    count(files_[i], surveyed != nullptr ? surveyed->num_frames : 0);
    if (surveyed == nullptr) return skip(files_[i], std::get<FormatError>(outcome));
    if (is_repeated(i, surveyed->hashes)) return;
    Clip clip;
    clip.actor = labels_of(files_[i].path).actor;
    label(files_[i], clip);
    if (seen.insert(body_key(clip.actor, surveyed->bones)).second)
      bodies.push_back(surveyed->bones);
    num_source_seconds_ += surveyed->duration_s;
    pending_.push_back({i, surveyed->hashes});
  };
  work_on_files(
      options_, files_.size(), [&](std::size_t i) { return survey_request(i); }, survey_file,
      decoded_survey, take, [&](std::size_t i) { show(files_[i]); });
  return bodies;
}

void Importer::recognise(DatabaseContent& content) {
  std::multimap<SourceHashes, std::string> held;
  std::set<std::string> held_sources;
  for (const Clip& clip : content.clips) {
    held.emplace(SourceHashes{clip.source_hash, clip.skeleton_hash}, clip.source);
    held_sources.insert(clip.source);
  }
  begin_pass(files_.size(), sum_of_bytes(files_), 2);
  const auto work = [&](std::size_t i, const std::stop_token&) -> Outcome<SourceHashes> {
    try {
      return hashes_of(files_[i].path, options_.read);
    } catch (const FormatError& error) {
      return error;
    }
  };
  const auto take = [&](std::size_t i, const Outcome<SourceHashes>& outcome) {
    const SourceFile& file = files_[i];
    count(file, 0);
    const auto* hashes = std::get_if<SourceHashes>(&outcome);
    if (hashes == nullptr) return skip(file, std::get<FormatError>(outcome));
    const auto [begin, end] = held.equal_range(*hashes);
    if (options_.takes.contains(file.path)) {
      if (is_repeated(i, *hashes)) return;
      for (auto known = begin; known != end; ++known) replaced_.insert(known->second);
      if (held_sources.contains(file.name)) replaced_.insert(file.name);
      pending_.push_back({i, *hashes});
      return;
    }
    const bool is_held = std::any_of(begin, end, [&](const auto& known) {
      return known.second == file.name || !options_.keep_duplicates;
    });
    if (is_held) {
      ++report_.num_known;
      for (Clip& clip : content.clips)
        if (clip.source == file.name) label(file, clip);
      return;
    }
    if (is_repeated(i, *hashes)) return;
    if (held_sources.contains(file.name)) replaced_.insert(file.name);
    pending_.push_back({i, *hashes});
  };
  work_in_order(files_.size(), options_.num_threads, work, take,
                [&](std::size_t i) { show(files_[i]); });
}

std::string Importer::first_missing(const DatabaseContent& content) const {
  std::set<SourceHashes> found;
  for (const auto& [hashes, file] : first_of_hash_) found.insert(hashes);
  for (const Clip& clip : content.clips)
    if (!found.contains({clip.source_hash, clip.skeleton_hash})) return clip.source;
  return "";
}

// --- Second pass ---------------------------------------------------------------------------------

// What later files must not repeat; clips that are about to go may be.
void Importer::know_clips(const DatabaseContent& content) {
  for (std::size_t c = 0; c < content.clips.size(); ++c) {
    const Clip& clip = content.clips[c];
    if (clip.is_copy() || replaced_.contains(clip.source)) continue;
    finder_.add(static_cast<int>(known_sources_.size()), unpacked(content.clip_rows[c]));
    known_sources_.push_back(clip.source);
  }
}

void Importer::know_body(const std::string& actor, const StandardBones& bones) {
  if (old_actors_.contains(actor)) return;
  const auto is_same = [&](const StandardBones& known) {
    return body_key("", known) == body_key("", bones);
  };
  if (std::none_of(new_bodies_.begin(), new_bodies_.end(), is_same)) new_bodies_.push_back(bones);
}

void Importer::import(DatabaseContent& content, const CopyOptions& copies) {
  const std::size_t num_old_clips = content.clips.size();
  for (const Clip& clip : content.clips)
    if (!clip.actor.empty()) old_actors_.insert(clip.actor);
  if (!options_.keep_duplicates) know_clips(content);
  std::uint64_t num_bytes = 0;
  for (const auto& pending : pending_) num_bytes += files_[pending.file].num_bytes;
  begin_pass(pending_.size(), num_bytes, 1);
  const auto request = [&](std::size_t i) {
    return ImportRequest{survey_request(pending_[i].file), pending_[i].hashes,
                         bones_of(content.skeleton), copies, options_.is_strict};
  };
  const auto take = [&](std::size_t i, Outcome<ImportedFile> outcome) {
    const SourceFile& file = files_[pending_[i].file];
    auto* imported = std::get_if<ImportedFile>(&outcome);
    count(file, imported != nullptr ? imported->clips.front().source_frames : 0);
    if (imported != nullptr && pair(file, content, *imported))
      return take_in(file, std::move(*imported), content);
    keep_old_clips(pending_[i], content);
    if (imported == nullptr) return skip(file, std::get<FormatError>(outcome));
    skip(file, FormatError({file.path}, "was not performed while the take was recorded"));
  };
  work_on_files(options_, pending_.size(), request, import_file, decoded_import, take,
                [&](std::size_t i) { show(files_[pending_[i].file]); });
  remove_replaced(content, num_old_clips);
  sort_doubtful();
}

// Puts the readings of the file's take in, if it has one; false when that is impossible.
bool Importer::pair(const SourceFile& file, const DatabaseContent& content,
                    ImportedFile& imported) {
  const auto take = options_.takes.find(file.path);
  if (take == options_.takes.end()) return true;
  return put_real_readings(take->second, content.skeleton, content.rate_hz, imported) > 0;
}

// What was to be replaced by a file that cannot be used.
void Importer::keep_old_clips(const Pending& pending, const DatabaseContent& content) {
  replaced_.erase(files_[pending.file].name);
  for (const Clip& clip : content.clips)
    if (SourceHashes{clip.source_hash, clip.skeleton_hash} == pending.hashes)
      replaced_.erase(clip.source);
}

void Importer::take_in(const SourceFile& file, ImportedFile imported, DatabaseContent& content) {
  if (!options_.keep_duplicates && !options_.takes.contains(file.path)) {
    const DatabaseRows rows = unpacked(imported.clip_rows.front());
    if (const auto same = finder_.find(rows)) {
      leave_out(file, "the same motion as " + known_sources_[static_cast<std::size_t>(*same)]);
      return;
    }
    finder_.add(static_cast<int>(known_sources_.size()), rows);
    known_sources_.push_back(file.name);
  }
  ++report_.num_files;
  report_.num_replaced += replaced_.contains(file.name) ? 1 : 0;
  report_.source_bytes += file.num_bytes;
  report_.source_frames += static_cast<std::uint64_t>(imported.clips.front().source_frames);
  report_.warnings.insert(report_.warnings.end(), imported.warnings.begin(),
                          imported.warnings.end());
  for (const ClipFault& fault : imported.faults) {
    report_.doubtful.push_back({file.path, FormatError({file.path}, fault.text).what()});
    severities_.push_back(fault.severity);
  }
  auto& skeletons = content.sources.skeletons;
  if (std::none_of(skeletons.begin(), skeletons.end(),
                   [&](const auto& known) { return known.id == imported.skeleton.id; }))
    skeletons.push_back(imported.skeleton);
  for (std::size_t c = 0; c < imported.clips.size(); ++c) {
    label(file, imported.clips[c]);
    if (c == 0) know_body(imported.clips[c].actor, imported.bones);
    content.clips.push_back(std::move(imported.clips[c]));
    content.clip_rows.push_back(std::move(imported.clip_rows[c]));
  }
}

void Importer::sort_doubtful() {
  std::vector<std::size_t> order(severities_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return severities_[a] > severities_[b]; });
  std::vector<SkippedFile> sorted;
  for (const std::size_t i : order) sorted.push_back(report_.doubtful[i]);
  report_.doubtful = std::move(sorted);
}

void Importer::remove_replaced(DatabaseContent& content, std::size_t num_old_clips) {
  if (replaced_.empty()) return;
  remove_clips(content, [&](std::size_t c) {
    return c < num_old_clips && replaced_.contains(content.clips[c].source);
  });
}

}  // namespace sparse_mocap
