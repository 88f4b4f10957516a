// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/formats/bvh_hierarchy.hpp"

namespace sparse_mocap {
namespace {

constexpr double kShortestFrame_s = 1e-4;
constexpr double kLongestFrame_s = 1.0;
constexpr const char* kRaiseFrames = "raise the limit max_frames if that is intended";
constexpr const char* kCompareChannels = "compare the row with the joints' CHANNELS";
// A joint whose position channels stay this close to its OFFSET does not move.
constexpr double kSameOffset_m = 1e-7;

// What one column of a frame's row does.
struct Column {
  std::size_t index = 0;
  Axis axis = Axis::x;
};

// The columns of a joint.
struct JointColumns {
  std::vector<Column> positions;
  std::vector<Column> rotations;  // outermost first
};

struct Header {
  int declared_frames = 0;
  FileLocation location;
  double frame_time_s = 0.0;
};

Skeleton skeleton_of(const BvhHierarchy& hierarchy) {
  std::vector<Joint> joints;
  std::vector<std::string> names;
  for (int j = 0; j < hierarchy.first_tree_end; ++j) {
    const auto& source = hierarchy.joints[static_cast<std::size_t>(j)];
    Joint joint;
    joint.parent = source.parent;
    joint.offset_parent = *source.offset;
    if (source.end_site && source.num_children == 1) joint.bone = *source.end_site;
    for (const auto& channel : *source.channels)
      if (channel.is_rotation) joint.axes.push_back(channel.axis);
    joints.push_back(std::move(joint));
    names.push_back(source.name);
  }
  names = unique_names(std::move(names));
  for (std::size_t j = 0; j < joints.size(); ++j) joints[j].name = std::move(names[j]);
  return Skeleton(std::move(joints));
}

void warn_about_renamed(const BvhHierarchy& hierarchy, const Skeleton& skeleton,
                        std::vector<ReadWarning>& warnings) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const auto& source = hierarchy.joints[static_cast<std::size_t>(j)];
    const auto& name = skeleton.joint(j).name;
    if (name == source.name) continue;
    add_warning(
        warnings, source.location,
        "a second joint named " + in_quotes(source.name) + "; it is renamed to " + in_quotes(name));
  }
}

// Reads the numbers below MOTION into a motion.
class MotionReader {
 public:
  MotionReader(TextScanner& scanner, const BvhHierarchy& hierarchy, const ReadOptions& options,
               MotionFile& file)
      : scanner_(scanner),
        options_(options),
        unit_m_(bvh_unit_m(options)),
        motion_(file.motion),
        warnings_(file.warnings) {
    std::size_t column = 0;
    for (int j = 0; j < static_cast<int>(hierarchy.joints.size()); ++j) {
      if (j < hierarchy.first_tree_end) columns_.emplace_back();
      for (const auto& channel : *hierarchy.joints[static_cast<std::size_t>(j)].channels) {
        const Column entry{column++, channel.axis};
        if (j >= hierarchy.first_tree_end) continue;
        (channel.is_rotation ? columns_.back().rotations : columns_.back().positions)
            .push_back(entry);
      }
    }
    row_.resize(column);
    track_of_joint_.assign(columns_.size(), -1);
  }

  void read() {
    header_ = read_header();
    motion_.frame_time_s = header_.frame_time_s;
    if (row_.empty() && !options_.allow_no_frames)
      throw FormatError(header_.location, "no joint has a channel",
                        "export the joints with their channels");
    reserve();
    while (!row_.empty() && !scanner_.at_end() && read_row()) append_frame();
    check_frame_count();
  }

 private:
  Header read_header();
  double read_field(std::string_view first_word, std::string_view second_word,
                    std::string_view what);
  void reserve();
  double frame_time_s(const Header& header, double value, std::string_view token);
  bool read_row();
  void append_frame();
  Vec3 position(std::size_t joint) const;
  void append_offset(std::size_t joint, const Vec3& offset);
  void check_frame_count();

  TextScanner& scanner_;
  const ReadOptions& options_;
  double unit_m_;
  Motion& motion_;
  std::vector<ReadWarning>& warnings_;
  std::vector<JointColumns> columns_;
  std::vector<double> row_;
  std::vector<int> track_of_joint_;  // index into the offset tracks, -1: none yet
  Header header_;
};

// "Frames: 12", "Frames :12", "Frame Time: 0.1" and the like.
double MotionReader::read_field(std::string_view first_word, std::string_view second_word,
                                std::string_view what) {
  for (const auto word : {first_word, second_word}) {
    if (word.empty()) continue;
    scanner_.at_end();
    const auto token = scanner_.next_until(":");
    if (equal_ignoring_case(token, word)) continue;
    const std::string got = token.empty() ? ", but the file ends" : ", got " + in_quotes(token);
    scanner_.fail(token, "expected " + std::string(what) + got,
                  "MOTION is followed by 'Frames: 12' and 'Frame Time: 0.01'");
  }
  scanner_.skip_character(':');
  return scanner_.number(what);
}

Header MotionReader::read_header() {
  Header header;
  scanner_.at_end();
  const auto frames_token = scanner_.peek();
  header.location = scanner_.location(frames_token);
  const double frames = read_field("Frames", "", "'Frames:' and a number");
  if (frames < 0 || frames != std::floor(frames))
    throw FormatError(header.location, "the number of frames must be a whole number, 0 or more",
                      "count the rows below");
  const int most = max_frames_of(static_cast<int>(columns_.size()), options_);
  if (frames > most)
    throw FormatError(header.location,
                      "the file declares more frames than the limit of " + std::to_string(most),
                      kRaiseFrames);
  header.declared_frames = static_cast<int>(frames);
  scanner_.at_end();
  const auto time_token = scanner_.peek();
  const double time = read_field("Frame", "Time", "'Frame Time:' and a number");
  header.frame_time_s = frame_time_s(header, time, time_token);
  return header;
}

// Files of poses, which have few frames, need none and exporters write 0.
double MotionReader::frame_time_s(const Header& header, double value, std::string_view token) {
  constexpr double kOfPoses_s = 1.0 / 30.0;
  constexpr int kMostPoses = 10;
  if (value >= kShortestFrame_s && value <= kLongestFrame_s) return value;
  if (value == 0.0 && header.declared_frames <= kMostPoses) {
    add_warning(warnings_, scanner_.location(token),
                "the frame time of these poses is 0; 1/30 s is used");
    return kOfPoses_s;
  }
  const auto seconds = [](double s) { return short_number(s) + " s"; };
  std::string remedy = "write the seconds between two frames";
  if (value > kLongestFrame_s && value <= 1.0 / kShortestFrame_s)
    remedy += ": " + short_number(value) + " frames per second are " + seconds(1.0 / value) + ", " +
              short_number(value) + " ms are " + seconds(0.001 * value);
  scanner_.fail(token, "the frame time is " + seconds(value) + ", it must be from 0.0001 to 1 s",
                remedy);
}

// Reserves no more frames than the remaining bytes can hold, whatever count is declared.
void MotionReader::reserve() {
  const auto possible = scanner_.bytes_left() / (2 * std::max<std::size_t>(1, row_.size())) + 1;
  const auto frames = std::min(static_cast<std::size_t>(header_.declared_frames), possible);
  motion_.root_positions.reserve(frames);
  motion_.rotations.reserve(frames * columns_.size());
}

// A row is usually a line; it may be wrapped, but a line never holds parts of two rows. False at
// the end of a file that holds all declared frames and a part of one more.
bool MotionReader::read_row() {
  std::size_t count = scanner_.numbers_on_line(row_.data(), row_.size());
  const auto row_name = [&] { return "row of frame " + std::to_string(motion_.num_frames() + 1); };
  const auto expected = [&] { return ", expected " + std::to_string(row_.size()); };
  if (count == row_.size()) {
    if (scanner_.at_line_end()) return true;
    scanner_.fail(scanner_.peek(), "the " + row_name() + " has more values" + expected(),
                  kCompareChannels);
  }
  while (count < row_.size()) {
    const auto line_end = scanner_.here();
    const std::string problem =
        "the " + row_name() + " has " + std::to_string(count) + " values" + expected();
    if (scanner_.at_end() && motion_.num_frames() >= std::max(1, header_.declared_frames)) {
      add_warning(warnings_, scanner_.location(line_end), problem + "; it is left out");
      return false;
    }
    if (scanner_.at_end()) scanner_.fail(line_end, problem, "the file may be cut off");
    count += scanner_.numbers_on_line(row_.data() + count, row_.size() - count);
    if (!scanner_.at_line_end()) scanner_.fail(line_end, problem, kCompareChannels);
  }
  return true;
}

void MotionReader::append_frame() {
  if (motion_.num_frames() >= max_frames_of(static_cast<int>(columns_.size()), options_))
    scanner_.fail(scanner_.here(),
                  "there are more frames than the limit of " + std::to_string(motion_.num_frames()),
                  kRaiseFrames);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    Quat rotation = Quat::Identity();
    for (const auto& [index, axis] : columns_[j].rotations)
      rotation = turned_about(rotation, axis, row_[index] * kRadiansPerDegree);
    motion_.rotations.push_back(rotation);
    if (j > 0 && !columns_[j].positions.empty()) append_offset(j, position(j));
  }
  motion_.root_positions.push_back(position(0));
}

// Position channels replace the OFFSET, component by component.
Vec3 MotionReader::position(std::size_t joint) const {
  Vec3 result = motion_.skeleton.joints()[joint].offset_parent;
  for (const auto& [index, axis] : columns_[joint].positions)
    result[static_cast<Eigen::Index>(axis)] = row_[index] * unit_m_;
  if (result.cwiseAbs().maxCoeff() > kMaxLength_m)
    scanner_.fail(scanner_.here(),
                  "a position in the row of frame " + std::to_string(motion_.num_frames() + 1) +
                      " is out of range",
                  "check the number and the unit of the file");
  return result;
}

// A track begins when the joint first leaves its OFFSET.
void MotionReader::append_offset(std::size_t joint, const Vec3& offset) {
  auto& tracks = motion_.offset_tracks;
  if (track_of_joint_[joint] < 0) {
    const Vec3& rest = motion_.skeleton.joints()[joint].offset_parent;
    if ((offset - rest).cwiseAbs().maxCoeff() <= kSameOffset_m) return;
    track_of_joint_[joint] = static_cast<int>(tracks.size());
    tracks.push_back({static_cast<int>(joint),
                      std::vector<Vec3>(static_cast<std::size_t>(motion_.num_frames()), rest)});
  }
  tracks[static_cast<std::size_t>(track_of_joint_[joint])].offset_parent.push_back(offset);
}

void MotionReader::check_frame_count() {
  const int rows = motion_.num_frames();
  if (rows == 0 && !options_.allow_no_frames)
    throw FormatError(header_.location, "the file has no frames",
                      "export the frames, or read only the skeleton");
  if (rows != header_.declared_frames)
    add_warning(warnings_, header_.location,
                "the file declares " + std::to_string(header_.declared_frames) +
                    " frames and has " + std::to_string(rows) + "; all that exist are read");
}

}  // namespace

MotionFile read_bvh(const std::filesystem::path& path, const ReadOptions& options) {
  options.validate();
  return bvh_from_text(read_motion_text(path, options), path, options);
}

MotionFile bvh_from_text(std::string text, const std::filesystem::path& path,
                         const ReadOptions& options) {
  options.validate();
  TextScanner scanner(path, std::move(text), {.punctuation = "{}"});
  MotionFile file;
  const auto hierarchy = read_bvh_hierarchy(scanner, options, file.warnings);
  file.motion.skeleton = skeleton_of(hierarchy);
  warn_about_renamed(hierarchy, file.motion.skeleton, file.warnings);
  MotionReader(scanner, hierarchy, options, file).read();
  // Many exporters have an odd rest pose, but the first frame shows a figure.
  const auto& motion = file.motion;
  warn_about_size(motion.num_frames() > 0 ? motion.transforms(0) : rest_pose(motion.skeleton),
                  hierarchy.joints[0].location, file.warnings);
  if (options.up != Axis::y) change_world(file.motion, 1.0, rotation_to_y(options.up));
  return file;
}

}  // namespace sparse_mocap
