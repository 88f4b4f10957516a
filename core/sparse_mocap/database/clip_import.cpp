// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_import.hpp"

#include <cctype>
#include <filesystem>
#include <new>
#include <optional>
#include <utility>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/database/clip_names.hpp"
#include "sparse_mocap/retargeting/mapping_error.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"

namespace sparse_mocap {
namespace {

// Shorter motions hold no second derivative worth having.
constexpr int kFewestFrames = 3;

void stop_if_asked(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

// Runs one file's work; what is wrong with the file is its outcome.
template <typename Result, typename Work>
Outcome<Result> outcome_of(const SourceFile& file, const Work& work) {
  const auto fault = [&](const std::string& what) { return FormatError({file.path}, what); };
  try {
    return work();
  } catch (const FormatError& error) {
    return error;
  } catch (const MappingError& error) {
    return fault(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fault("cannot be read: " + error.code().message());
  } catch (const std::bad_alloc&) {
    return fault("needs more memory than there is");
  }
}

MotionFile read_with_frames(const SourceFile& file, const ReadOptions& options) {
  MotionFile read = read_motion_file(file.path, options);
  if (read.motion.num_frames() < kFewestFrames)
    throw FormatError({file.path}, "has fewer than 3 frames");
  return read;
}

SourceSkeleton described(const Skeleton& source, const SkeletonMapping& mapping) {
  SourceSkeleton skeleton;
  skeleton.num_joints = source.num_joints();
  skeleton.unit_scale = mapping.unit_scale;
  skeleton.joints = mapped_joint_names(source, mapping);
  std::string identity = std::to_string(mapping.unit_scale);
  for (const Joint& joint : source.joints())
    identity.append("\n").append(joint.name).append(" ").append(std::to_string(joint.parent));
  for (const auto& [standard, name] : skeleton.joints)
    identity.append("\n").append(standard).append(" ").append(name);
  skeleton.id = checksum(std::as_bytes(std::span(identity)));
  return skeleton;
}

// A movement on a database's skeleton, and on the body's own where its readings are taken there.
struct Moves {
  Motion standard;
  std::optional<Motion> own;

  template <typename Change>
  Moves changed(const Change& change) const {
    Moves other{change(standard), {}};
    if (own) other.own = change(*own);
    return other;
  }
};

// Makes a file's clips: the motion itself and its copies.
class ClipMaker {
 public:
  ClipMaker(const CopyOptions& copies, const std::stop_token& stop, ImportedFile& out)
      : copies_(copies), stop_(stop), out_(out) {}

  void add_mirrored(Clip clip, const Moves& moves) {
    add_reversed(clip, moves);
    if (!copies_.add_mirrored) return;
    clip.is_mirrored = true;
    for (std::size_t left = 0, right = 3; left < 3; ++left, ++right)
      std::swap(clip.has_extremity[left], clip.has_extremity[right]);
    add_reversed(clip, moves.changed([](const Motion& motion) {
      return mirrored(motion, left_right_with_extremities());
    }));
  }

 private:
  void add_reversed(Clip clip, const Moves& moves) {
    add_tempos(clip, moves);
    if (!copies_.add_reversed) return;
    clip.is_reversed = true;
    add_tempos(clip, moves.changed([](const Motion& motion) { return reversed(motion); }));
  }

  void add_tempos(Clip clip, const Moves& moves) {
    add_copy(clip, moves);
    for (const double tempo : copies_.tempos) {
      clip.tempo = tempo;
      add_copy(clip, moves.changed([tempo](Motion copy) {
        copy.frame_time_s /= tempo;
        return copy;
      }));
    }
  }

  void add_copy(Clip clip, const Moves& moves) {
    stop_if_asked(stop_);
    PackedRows rows = packed(
        database_rows(moves.standard, copies_.rate_hz, moves.own ? *moves.own : moves.standard));
    if (rows.num_frames() < kFewestFrames) return;
    if (!out_.clips.empty()) clip.warnings.clear();
    out_.clip_rows.push_back(std::move(rows));
    out_.clips.push_back(std::move(clip));
  }

  const CopyOptions& copies_;
  const std::stop_token& stop_;
  ImportedFile& out_;
};

Clip clip_of(const SourceFile& file, const SourceHashes& hashes, const Motion& motion) {
  const ClipLabels labels = labels_of(file.path);
  Clip clip;
  clip.name = labels.name;
  clip.actor = labels.actor;
  clip.motion_class = labels.motion_class;
  clip.source = file.name;
  clip.source_hash = hashes.file;
  clip.skeleton_hash = hashes.skeleton;
  clip.source_frames = motion.num_frames();
  clip.source_rate_hz = 1.0 / motion.frame_time_s;
  return clip;
}

}  // namespace

Outcome<SurveyedFile> survey_file(const SurveyRequest& request, const std::stop_token& stop) {
  return outcome_of<SurveyedFile>(request.file, [&] {
    SurveyedFile surveyed;
    surveyed.hashes = hashes_of(request.file.path, request.read);
    const MotionFile read = read_with_frames(request.file, request.read);
    stop_if_asked(stop);
    surveyed.bones = map_as_chosen(read.motion, request.mapping).bones;
    surveyed.num_frames = read.motion.num_frames();
    surveyed.duration_s = read.motion.duration_s();
    return surveyed;
  });
}

Outcome<ImportedFile> import_file(const ImportRequest& request, const std::stop_token& stop) {
  const SourceFile& file = request.file;
  return outcome_of<ImportedFile>(file, [&] {
    ImportedFile out;
    const MotionFile read = read_with_frames(file, request.read);
    stop_if_asked(stop);
    const SkeletonMapping mapping = map_as_chosen(read.motion, request.mapping);
    std::vector<std::string> texts = mapping.warnings;
    const Skeleton standard = with_extremities(make_standard_skeleton(request.bones));
    Moves moves{to_standard(read.motion, mapping, standard, &texts), {}};
    if (request.copies.has_own_proportions)
      moves.own = to_standard(read.motion, mapping,
                              with_extremities(make_standard_skeleton(mapping.bones)));
    out.faults = check_clip(read.motion, mapping, moves.standard);
    for (const ClipFault& fault : out.faults)
      if (fault.is_refused || request.is_strict) throw FormatError({file.path}, fault.text);
    out.skeleton = described(read.motion.skeleton, mapping);
    out.bones = mapping.bones;
    Clip clip = clip_of(file, request.hashes, read.motion);
    clip.skeleton = out.skeleton.id;
    for (std::size_t e = 0; e < mapping.extremities.size(); ++e)
      clip.has_extremity[e] = mapping.extremities[e].joint >= 0;
    for (const auto& warning : read.warnings) {
      out.warnings.push_back(warning.message());
      clip.warnings[kind_of_warning(warning.text)] += warning.count;
    }
    for (const ClipFault& fault : out.faults) ++clip.warnings[kind_of_warning(fault.text)];
    for (const auto& text : texts) {
      out.warnings.push_back(file.path.filename().string() + ": " + text);
      ++clip.warnings[kind_of_warning(text)];
    }
    ClipMaker(request.copies, stop, out).add_mirrored(clip, moves);
    if (out.clips.empty() || out.clips.front().is_copy())
      throw FormatError({file.path}, "is too short for the database's frame rate");
    return out;
  });
}

std::string kind_of_warning(const std::string& warning) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::string kind;
  for (std::size_t i = 0; i < warning.size(); ++i) {
    const auto quote = warning[i] == '\'' ? warning.find('\'', i + 1) : std::string::npos;
    if (quote != std::string::npos) {
      kind += "'...'";
      i = quote;
    } else if (is_digit(warning[i])) {
      while (i + 1 < warning.size() &&
             (is_digit(warning[i + 1]) ||
              (warning[i + 1] == '.' && i + 2 < warning.size() && is_digit(warning[i + 2]))))
        ++i;
      kind += '#';
    } else {
      kind += warning[i];
    }
  }
  return kind;
}

}  // namespace sparse_mocap
