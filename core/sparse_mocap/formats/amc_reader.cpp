// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/asf_sections.hpp"

namespace sparse_mocap {
namespace {

constexpr std::size_t kMaxChannels = 7;
constexpr double kSmallestRate_hz = 1.0;
constexpr double kLargestRate_hz = 10'000.0;

bool is_translation(AcclaimChannel channel) {
  return channel >= AcclaimChannel::tx && channel <= AcclaimChannel::tz;
}

// Reads the frames of an .amc one bone line at a time.
class AmcReader {
 public:
  AmcReader(TextScanner& scanner, const AcclaimSkeleton& skeleton, const ReadOptions& options);
  MotionFile read();

 private:
  using Values = std::array<double, kMaxChannels>;

  void read_header();
  void read_sample_rate();
  bool at_frame_number();
  void read_frame_number();
  void read_frame();
  void read_bone_line(std::string_view name);
  int joint_named(std::string_view name);
  void apply(std::size_t joint, const Values& values);
  Vec3 translation(std::size_t joint, const Values& values) const;
  void check_complete(std::string_view frame_token) const;
  std::string frame_name() const { return "frame " + std::to_string(frame_number_); }
  void warn(std::string_view token, const std::string& text) {
    add_warning(file_.warnings, scanner_.location(token), text);
  }

  TextScanner& scanner_;
  const AcclaimSkeleton& skeleton_;
  const ReadOptions& options_;
  MotionFile file_;
  double radians_per_angle_;
  std::map<std::string, int> joint_by_name_;
  std::vector<Quat> R_axes_;         // R_joint_axes of every joint
  std::vector<int> track_of_joint_;  // index into the offset tracks, -1: the joint has none
  std::vector<char> is_given_;       // in the current frame
  std::vector<int> line_order_;      // the joints in the order of the first frame's lines
  std::size_t line_ = 0;             // in the current frame
  long long frame_number_ = 0;
  long long missing_frames_ = 0;
  bool has_stretch_ = false;
};

AmcReader::AmcReader(TextScanner& scanner, const AcclaimSkeleton& skeleton,
                     const ReadOptions& options)
    : scanner_(scanner),
      skeleton_(skeleton),
      options_(options),
      radians_per_angle_(skeleton.radians_per_angle) {
  auto& motion = file_.motion;
  motion.skeleton = skeleton.skeleton;
  motion.frame_time_s = 1.0 / options.amc_rate_hz;
  for (int j = 0; j < skeleton.skeleton.num_joints(); ++j) {
    const auto& joint = skeleton.skeleton.joint(j);
    joint_by_name_.emplace(lower_case(joint.name), j);
    R_axes_.emplace_back(joint.R_joint_axes);
    const auto& channels = skeleton.channels[static_cast<std::size_t>(j)];
    const bool has_track = j > 0 && std::ranges::any_of(channels, is_translation);
    track_of_joint_.push_back(has_track ? static_cast<int>(motion.offset_tracks.size()) : -1);
    if (has_track) motion.offset_tracks.push_back({j, {}});
  }
}

MotionFile AmcReader::read() {
  read_header();
  while (!scanner_.at_end()) read_frame();
  if (file_.motion.num_frames() == 0 && !options_.allow_no_frames)
    scanner_.fail(scanner_.here(), "the file has no frames",
                  "export the frames, or read only the skeleton");
  if (missing_frames_ > 0)
    add_warning(
        file_.warnings, {scanner_.path()},
        std::to_string(missing_frames_) + " frame numbers are missing; the gaps are closed");
  if (has_stretch_)
    add_warning(file_.warnings, {scanner_.path()},
                "channel l (stretch of a bone) is not zero; it is ignored");
  return std::move(file_);
}

void AmcReader::read_header() {
  if (scanner_.at_end()) scanner_.fail(scanner_.here(), "the file is empty", "export it again");
  bool is_fully_specified = false;
  bool has_unit = false;
  while (scanner_.peek().starts_with(':')) {
    const auto keyword = scanner_.next();
    if (equal_ignoring_case(keyword, ":FULLY-SPECIFIED")) {
      is_fully_specified = true;
    } else if (equal_ignoring_case(keyword, ":DEGREES")) {
      has_unit = true;
      radians_per_angle_ = kRadiansPerDegree;
    } else if (equal_ignoring_case(keyword, ":RADIANS")) {
      has_unit = true;
      radians_per_angle_ = 1.0;
    } else if (equal_ignoring_case(keyword, ":SAMPLES-PER-SECOND")) {
      read_sample_rate();
    } else {
      warn(keyword, in_quotes(keyword) + " is unknown; it is ignored");
      scanner_.rest_of_line();
    }
  }
  if (!is_fully_specified) warn(scanner_.here(), ":FULLY-SPECIFIED is missing");
  if (!has_unit)
    warn(scanner_.here(), std::string(":DEGREES is missing; ") +
                              (radians_per_angle_ == 1.0 ? "radians" : "degrees") +
                              " are assumed as in the .asf");
}

void AmcReader::read_sample_rate() {
  const auto token = scanner_.peek();
  const double rate_hz = scanner_.number("a number after :SAMPLES-PER-SECOND");
  if (rate_hz < kSmallestRate_hz || rate_hz > kLargestRate_hz)
    scanner_.fail(token, "the rate must be from 1 to 10000 samples a second", "correct it");
  file_.motion.frame_time_s = 1.0 / rate_hz;
}

bool AmcReader::at_frame_number() {
  const auto token = scanner_.peek();
  double ignored = 0.0;
  return scanner_.starts_line(token) && parse_number(token, ignored) == NumberStatus::ok;
}

void AmcReader::read_frame_number() {
  const auto token = scanner_.peek();
  if (token.starts_with(':'))
    scanner_.fail(token, "a second header " + in_quotes(token) + " after " + frame_name(),
                  "remove it, or cut the file in two");
  const double number = scanner_.number("a frame number");
  const bool is_number = number >= 0 && number <= 1e15 && number == std::floor(number);
  if (!is_number || !scanner_.at_line_end())
    scanner_.fail(token, "expected a frame number alone on its line, got " + in_quotes(token),
                  "number the frames 1, 2, 3 and so on");
  const auto next = static_cast<long long>(number);
  if (file_.motion.num_frames() > 0) {
    if (next == frame_number_)
      scanner_.fail(token, frame_name() + " occurs twice", "remove one of them");
    if (next < frame_number_)
      scanner_.fail(
          token, "frame number " + std::string(token) + " follows " + std::to_string(frame_number_),
          "put the frames in order");
    if (next > frame_number_ + 1 && missing_frames_ == 0)
      warn(token,
           "frame number " + std::string(token) + " follows " + std::to_string(frame_number_));
    missing_frames_ += next - frame_number_ - 1;
  }
  frame_number_ = next;
}

void AmcReader::read_frame() {
  auto& motion = file_.motion;
  const auto frame_token = scanner_.peek();
  read_frame_number();
  const int most = max_frames_of(motion.skeleton.num_joints(), options_);
  if (motion.num_frames() >= most)
    scanner_.fail(frame_token, "there are more frames than the limit of " + std::to_string(most),
                  "raise the limit max_frames if that is intended");
  motion.rotations.resize(motion.rotations.size() + R_axes_.size(), Quat::Identity());
  motion.root_positions.emplace_back(skeleton_.root_position);
  for (auto& track : motion.offset_tracks) track.offset_parent.emplace_back(Vec3::Zero());
  is_given_.assign(R_axes_.size(), 0);
  line_ = 0;
  while (!scanner_.at_end() && !scanner_.peek().starts_with(':') && !at_frame_number())
    read_bone_line(scanner_.next());
  check_complete(frame_token);
}

void AmcReader::read_bone_line(std::string_view name) {
  const auto joint = static_cast<std::size_t>(joint_named(name));
  if (is_given_[joint])
    scanner_.fail(name, "bone " + in_quotes(name) + " occurs twice in " + frame_name(),
                  "remove one of the lines");
  is_given_[joint] = 1;
  const auto& channels = skeleton_.channels[joint];
  Values values{};
  const auto count = scanner_.numbers_on_line(values.data(), channels.size());
  if (count < channels.size() || !scanner_.at_line_end())
    scanner_.fail(count < channels.size() ? scanner_.here() : scanner_.peek(),
                  "bone " + in_quotes(name) + " in " + frame_name() + " needs " +
                      std::to_string(channels.size()) + " values, got " +
                      (count < channels.size() ? std::to_string(count) : "more"),
                  "the skeleton is " + skeleton_.path.string());
  apply(joint, values);
}

// Nearly every frame lists its bones in the order of the first one.
int AmcReader::joint_named(std::string_view name) {
  const auto line = line_++;
  if (line < line_order_.size()) {
    const int joint = line_order_[line];
    if (skeleton_.skeleton.joint(joint).name == name) return joint;
  }
  const auto found = joint_by_name_.find(lower_case(escaped_to_utf8(name)));
  if (found == joint_by_name_.end())
    scanner_.fail(name, "bone " + in_quotes(name) + " is not in " + skeleton_.path.string(),
                  "use the .asf of this actor");
  if (line >= line_order_.size()) line_order_.push_back(found->second);
  return found->second;
}

void AmcReader::apply(std::size_t joint, const Values& values) {
  auto& motion = file_.motion;
  const auto& channels = skeleton_.channels[joint];
  Quat turn = Quat::Identity();
  for (std::size_t i = channels.size(); i-- > 0;) {
    if (channels[i] <= AcclaimChannel::rz)
      turn = turned_about(turn, static_cast<Axis>(channels[i]), values[i] * radians_per_angle_);
    if (channels[i] == AcclaimChannel::length && values[i] != 0.0) has_stretch_ = true;
  }
  const auto& A = R_axes_[joint];
  motion.rotations[motion.rotations.size() - R_axes_.size() + joint] = A * turn * A.conjugate();
  if (joint == 0) motion.root_positions.back() += translation(joint, values);
  if (track_of_joint_[joint] >= 0)
    motion.offset_tracks[static_cast<std::size_t>(track_of_joint_[joint])].offset_parent.back() =
        A * translation(joint, values);
}

Vec3 AmcReader::translation(std::size_t joint, const Values& values) const {
  Vec3 result = Vec3::Zero();
  const auto& channels = skeleton_.channels[joint];
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (is_translation(channels[i]))
      result[static_cast<int>(channels[i]) - static_cast<int>(AcclaimChannel::tx)] =
          values[i] * skeleton_.metres_per_unit;
  if (result.cwiseAbs().maxCoeff() > kMaxLength_m)
    scanner_.fail(scanner_.here(), "a position in " + frame_name() + " is out of range",
                  "check the number and the unit of the .asf");
  return result;
}

void AmcReader::check_complete(std::string_view frame_token) const {
  for (std::size_t j = 0; j < is_given_.size(); ++j) {
    if (is_given_[j] || skeleton_.channels[j].empty()) continue;
    const auto& name = file_.motion.skeleton.joint(static_cast<int>(j)).name;
    const bool is_at_end = scanner_.bytes_left() == 0;
    const int complete = file_.motion.num_frames() - 1;
    scanner_.fail(is_at_end ? scanner_.here() : frame_token,
                  "bone " + in_quotes(name) + " is missing in " + frame_name(),
                  is_at_end ? "the file may be cut off; " + std::to_string(complete) +
                                  " complete frames come before"
                            : "the skeleton is " + skeleton_.path.string());
  }
}

}  // namespace

MotionFile read_amc(const std::filesystem::path& amc_path, const AcclaimSkeleton& skeleton,
                    const ReadOptions& options) {
  options.validate();
  return amc_from_text(read_motion_text(amc_path, options), amc_path, skeleton, options);
}

MotionFile amc_from_text(std::string text, const std::filesystem::path& amc_path,
                         const AcclaimSkeleton& skeleton, const ReadOptions& options) {
  options.validate();
  TextScanner scanner(amc_path, std::move(text), kAcclaimSyntax);
  return AmcReader(scanner, skeleton, options).read();
}

}  // namespace sparse_mocap
