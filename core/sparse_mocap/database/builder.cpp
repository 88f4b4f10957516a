// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/database/clip_names.hpp"
#include "sparse_mocap/database/safetensors.hpp"
#include "sparse_mocap/motion/contacts.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/motion/humanoid.hpp"
#include "sparse_mocap/sensors/filter.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;

// Shorter motions hold no second derivative worth having.
constexpr int kFewestFrames = 3;

bool is_excluded(const fs::path& path, const std::vector<std::string>& exclude) {
  const std::string name = path.filename().string();
  return std::any_of(exclude.begin(), exclude.end(),
                     [&](const std::string& pattern) { return matches_glob(pattern, name); });
}

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

class Builder {
 public:
  Builder(std::vector<fs::path> files, const BuildOptions& options, const Progress& progress)
      : files_(std::move(files)), options_(options), progress_(progress) {}

  BuildReport build(const fs::path& output) {
    measure_bodies();
    add_clips();
    if (content_.clips.empty())
      throw FormatError({files_.front().parent_path()},
                        "none of " + std::to_string(files_.size()) + " motion files can be used",
                        "first reason: " + report_.skipped.front().reason);
    content_.build_info = build_info();
    const auto file = encode_database(content_);
    const std::span<const std::byte> piece(file);
    write_file_atomically(output, std::span(&piece, 1));
    return std::move(report_);
  }

 private:
  // Runs one file's work; what is wrong with the file is its own affair unless strict.
  template <typename Work>
  bool guarded(const fs::path& path, Work&& work) {
    try {
      work();
      return true;
    } catch (const FormatError& error) {
      if (options_.is_strict) throw;
      report_.skipped.push_back({path, error.what()});
    } catch (const MappingError& error) {
      if (options_.is_strict) throw FormatError({path}, error.what());
      report_.skipped.push_back({path, path.string() + ": " + error.what()});
    }
    return false;
  }

  // First pass: the standard skeleton is the mean over the bodies of all usable files.
  void measure_bodies() {
    std::set<BodyKey> seen;
    std::vector<StandardBones> bodies;
    std::vector<fs::path> usable;
    for (std::size_t i = 0; i < files_.size(); ++i) {
      const fs::path& path = files_[i];
      progress_.report(i, 2 * files_.size(), path.filename().string());
      const bool is_usable = guarded(path, [&] {
        const MotionFile file = read_motion_file(path, options_.read);
        if (file.motion.num_frames() < kFewestFrames)
          throw FormatError({path}, "has fewer than 3 frames");
        const auto mapping = map_humanoid(file.motion);
        if (seen.insert(body_key(labels_of(path).actor, mapping.bones)).second)
          bodies.push_back(mapping.bones);
        num_source_seconds_ += file.motion.duration_s();
      });
      if (is_usable) usable.push_back(path);
    }
    num_measured_ = files_.size();
    if (bodies.empty()) return;
    files_in_use_ = std::move(usable);
    content_.skeleton = make_standard_skeleton(averaged_bones(bodies));
    content_.rate_hz = options_.rate_hz;
    num_bodies_ = bodies.size();
    decide_tempo_copies();
  }

  void decide_tempo_copies() {
    double frames = num_source_seconds_ * options_.rate_hz;
    frames *= (options_.add_mirrored ? 2.0 : 1.0) * (options_.add_reversed ? 2.0 : 1.0);
    double with_copies = frames;
    for (const double tempo : options_.tempo_copies) with_copies += frames / tempo;
    if (with_copies <= options_.max_frames_with_copies) {
      tempo_copies_ = options_.tempo_copies;
    } else if (!options_.tempo_copies.empty()) {
      report_.warnings.push_back("copies at other tempos are left out: they would make " +
                                 std::to_string(std::lround(with_copies)) + " frames");
    }
  }

  // Second pass: every file on that skeleton.
  void add_clips() {
    for (std::size_t i = 0; i < files_in_use_.size(); ++i) {
      const fs::path& path = files_in_use_[i];
      progress_.report(num_measured_ + i, num_measured_ + files_in_use_.size(),
                       path.filename().string());
      guarded(path, [&] { add_file(path); });
    }
  }

  void add_file(const fs::path& path) {
    const MotionFile file = read_motion_file(path, options_.read);
    for (const auto& warning : file.warnings)
      report_.warnings.push_back(warning.message());
    auto mapping = map_humanoid(file.motion);
    std::vector<std::string> warnings = mapping.warnings;
    const Motion motion = to_standard(file.motion, mapping, content_.skeleton, &warnings);
    for (const auto& warning : warnings)
      report_.warnings.push_back(path.filename().string() + ": " + warning);
    const ClipLabels labels = labels_of(path);
    const std::string text = read_file(path, options_.read.max_bytes);
    Clip clip;
    clip.name = labels.name;
    clip.actor = labels.actor;
    clip.motion_class = labels.motion_class;
    clip.source = path.filename().string();
    clip.source_hash = checksum(std::as_bytes(std::span(text)));
    add_mirrored(clip, motion);
    ++report_.num_files;
  }

  void add_mirrored(Clip clip, const Motion& motion) {
    add_reversed(clip, motion);
    if (!options_.add_mirrored) return;
    clip.is_mirrored = true;
    add_reversed(clip, mirrored(motion, standard_left_right()));
  }

  void add_reversed(Clip clip, const Motion& motion) {
    add_tempos(clip, motion);
    if (!options_.add_reversed) return;
    clip.is_reversed = true;
    add_tempos(clip, reversed(motion));
  }

  void add_tempos(Clip clip, const Motion& motion) {
    add_copy(clip, motion);
    for (const double tempo : tempo_copies_) {
      clip.tempo = tempo;
      Motion copy = motion;
      copy.frame_time_s /= tempo;
      add_copy(clip, copy);
    }
  }

  void add_copy(const Clip& clip, const Motion& motion) {
    DatabaseRows rows = database_rows(motion, options_.rate_hz);
    if (rows.num_frames() < kFewestFrames) return;
    content_.clip_rows.push_back(std::move(rows));
    content_.clips.push_back(clip);
    ++report_.num_clips;
    report_.num_frames += content_.clip_rows.back().num_frames();
  }

  std::string build_info() const {
    return nlohmann::json{{"software", "sparse_mocap " SPARSE_MOCAP_VERSION},
                          {"mirror", options_.add_mirrored},
                          {"reverse", options_.add_reversed},
                          {"tempo_copies", tempo_copies_},
                          {"exclude", options_.exclude},
                          {"files", report_.num_files},
                          {"bodies", num_bodies_},
                          {"skipped", report_.skipped.size()},
                          {"warnings", report_.warnings.size()}}
        .dump();
  }

  std::vector<fs::path> files_;
  std::vector<fs::path> files_in_use_;
  const BuildOptions& options_;
  const Progress& progress_;
  std::size_t num_measured_ = 0;
  std::size_t num_bodies_ = 0;
  double num_source_seconds_ = 0.0;
  std::vector<double> tempo_copies_;
  DatabaseContent content_;
  BuildReport report_;
};

// rows x frames at the motion's rate to frames x rows at the database's.
DatabaseRows::Rows sampled(const Eigen::MatrixXd& values, const std::vector<double>& times_s,
                           const std::vector<double>& wanted_s) {
  return filtered_at(times_s, values, wanted_s, kReadingFilter).transpose().cast<float>();
}

void fill_readings(const Motion& motion, const std::vector<double>& wanted_s, DatabaseRows& rows) {
  std::vector<double> times_s;
  for (int t = 0; t < motion.num_frames(); ++t) times_s.push_back(t * motion.frame_time_s);
  const auto n = static_cast<Eigen::Index>(wanted_s.size());
  const auto columns = static_cast<Eigen::Index>(3 * all_sites().size());
  for (auto* target :
       {&rows.specific_force_pivot, &rows.specific_force_end, &rows.angular_velocity, &rows.up})
    target->resize(n, columns);
  const auto readings = virtual_readings(motion, all_sites());
  for (std::size_t s = 0; s < readings.size(); ++s) {
    const auto at = static_cast<Eigen::Index>(3 * s);
    const VirtualReadings& r = readings[s];
    rows.specific_force_pivot.middleCols(at, 3) =
        sampled(r.specific_force_pivot, times_s, wanted_s);
    rows.specific_force_end.middleCols(at, 3) = sampled(r.specific_force_end, times_s, wanted_s);
    rows.angular_velocity.middleCols(at, 3) = sampled(r.angular_velocity, times_s, wanted_s);
    rows.up.middleCols(at, 3) = sampled(r.up, times_s, wanted_s).rowwise().normalized();
  }
}

// The height of the floor: zero, as recordings have it, unless the ankles never come near it.
double floor_height(const std::vector<JointTransforms>& poses) {
  constexpr double kStandingAnkle_m = 0.08, kHighestStandingAnkle_m = 0.25;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& pose : poses)
    for (const auto ankle : {standard_joint::ltibia, standard_joint::rtibia})
      lowest = std::min(lowest, pose.end[ankle].y());
  const bool is_on_the_floor = lowest >= 0.0 && lowest <= kHighestStandingAnkle_m;
  return is_on_the_floor ? 0.0 : lowest - kStandingAnkle_m;
}

// Root motion as rates in the heading frame (method: integrated by root_motion of tautges2011).
DatabaseRows::Rows root_motion_rows(const Motion& motion, const std::vector<double>& yaw) {
  using namespace root_motion_column;
  const int n = motion.num_frames();
  std::vector<JointTransforms> poses;
  for (int t = 0; t < n; ++t) poses.push_back(motion.transforms(t));
  const double floor = floor_height(poses);
  DatabaseRows::Rows rows(n, count);
  for (int t = 0; t < n; ++t) {
    const auto now = static_cast<std::size_t>(std::max(t, 1));
    const std::size_t before = now - 1;
    const Vec3 step = yaw_rotation(yaw[before]).transpose() *
                      (motion.root_positions[now] - motion.root_positions[before]) /
                      motion.frame_time_s;
    rows(t, velocity_left) = static_cast<float>(step.x());
    rows(t, velocity_forward) = static_cast<float>(step.z());
    rows(t, yaw_rate) = static_cast<float>((yaw[now] - yaw[before]) / motion.frame_time_s);
    rows(t, height) = static_cast<float>(poses[static_cast<std::size_t>(t)].end[0].y() - floor);
  }
  return rows;
}

}  // namespace

std::vector<fs::path> find_motion_files(const std::vector<fs::path>& sources,
                                        const std::vector<std::string>& exclude) {
  std::vector<fs::path> files;
  for (const auto& source : sources) {
    if (!fs::exists(source))
      throw FormatError({source}, "no such file or folder", "check the path");
    if (!fs::is_directory(source)) {
      if (!is_motion_file(source))
        throw FormatError({source}, "is neither .bvh nor .amc", "name motion files or folders");
      files.push_back(source);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(source))
      if (entry.is_regular_file() && is_motion_file(entry.path())) files.push_back(entry.path());
  }
  if (files.empty())
    throw FormatError({sources.empty() ? fs::path() : sources.front()},
                      "holds no .bvh or .amc file", "name a folder of motion capture");
  std::erase_if(files, [&](const fs::path& path) { return is_excluded(path, exclude); });
  if (files.empty())
    throw FormatError({sources.front()}, "every motion file is excluded", "exclude fewer");
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

BuildReport build_database(const std::vector<fs::path>& sources, const fs::path& output,
                           const BuildOptions& options, const Progress& progress) {
  if (!(options.rate_hz >= 1.0 && options.rate_hz <= 1000.0))
    throw ConfigError("the frame rate must be between 1 and 1000 Hz, got " +
                      std::to_string(options.rate_hz));
  for (const double tempo : options.tempo_copies)
    if (!(tempo >= 0.25 && tempo <= 4.0))
      throw ConfigError("a tempo must be between 0.25 and 4, got " + std::to_string(tempo));
  return Builder(find_motion_files(sources, options.exclude), options, progress).build(output);
}

DatabaseRows database_rows(const Motion& standard_motion, double rate_hz) {
  Motion motion = resampled(standard_motion, rate_hz);
  const auto yaw = headings(motion);
  DatabaseRows rows;
  rows.positions = joint_positions(motion, PositionFrame::heading).transpose().cast<float>();
  rows.contacts = foot_contacts(motion).transpose().cast<float>();
  rows.root_motion = root_motion_rows(motion, yaw);
  std::vector<double> wanted_s;
  for (int t = 0; t < motion.num_frames(); ++t) {
    wanted_s.push_back(t / rate_hz);
    motion.rotation(t, 0) =
        Quat(yaw_rotation(yaw[static_cast<std::size_t>(t)])).conjugate() * motion.rotation(t, 0);
  }
  rows.angles = standard_angles(motion).transpose().cast<float>();
  fill_readings(standard_motion, wanted_s, rows);
  return rows;
}

}  // namespace sparse_mocap
