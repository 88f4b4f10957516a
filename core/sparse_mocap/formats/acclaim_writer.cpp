// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/acclaim_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/formats/reader_support.hpp"

namespace sparse_mocap {
namespace {

constexpr double kLengthUnit = 0.45;  // a value of the file is value / kLengthUnit inches
constexpr double kUnitsPerMetre = kLengthUnit / 0.0254;
constexpr int kSkeletonDigits = 12;
constexpr int kMotionDecimals = 6;  // 6e-8 m and 2e-8 rad
// Rotations that differ by less than this (largest matrix element) count as equal.
constexpr double kSameRotation = 1e-8;
constexpr double kShortestFrame_s = 1e-4;
constexpr double kLongestFrame_s = 1.0;

// A bone of the file; bone 0 is the root.
struct Bone {
  std::string name;
  int parent = -1;
  Vec3 vector = Vec3::Zero();  // m, in the frame of the file's rest pose
  Joint turning;               // only its axes: R_joint_axes and axes
  int joint = -1;              // of the motion; -1: a fixed bone
  const OffsetTrack* track = nullptr;
  Vec3 offset = Vec3::Zero();  // m, the joint's own; what the track differs from it is tx ty tz
};

void append_digits(std::string& text, double value) {
  std::array<char, 64> digits{};
  auto* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                  std::chars_format::general, kSkeletonDigits)
                        .ptr;
  text += ' ';
  text.append(digits.data(), end);
}

// Without trailing zeros, as in other programs' files.
void append_decimals(std::string& text, double value) {
  std::array<char, 64> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::fixed, kMotionDecimals);
  std::string_view number(digits.data(), error == std::errc{} ? end : digits.data());
  while (number.ends_with('0')) number.remove_suffix(1);
  if (number.ends_with('.')) number.remove_suffix(1);
  text += ' ';
  text += number == "-0" ? "0" : number;
}

std::string writable_name(std::string name) {
  constexpr std::string_view kSpecial = ",()#:";
  for (std::size_t i = 0; i < name.size(); ++i) {
    char& c = name[i];
    const bool is_blank_or_control = static_cast<unsigned char>(c) <= ' ' || c == '\x7F';
    const bool is_special = kSpecial.find(c) != std::string_view::npos;
    // Inside a word, a colon is an ordinary character.
    if (is_blank_or_control || (is_special && (c != ':' || i == 0))) c = '_';
  }
  double ignored = 0.0;
  const bool is_number = parse_number(name, ignored) != NumberStatus::malformed;
  return is_number ? "_" + name : name;
}

// The angles about x, y and z (degrees) with R = Rz * Ry * Rx: `axis x y z XYZ` in the file.
Vec3 xyz_angles(const Mat3& R) {
  Joint zyx;
  zyx.axes = {Axis::z, Axis::y, Axis::x};
  std::array<double, 3> angles{};
  joint_angles(zyx, R, nullptr, angles.data());
  Vec3 degrees = Vec3(angles[2], angles[1], angles[0]) / kRadiansPerDegree;
  for (double& angle : degrees)
    if (std::abs(angle) < 1e-10) angle = 0.0;
  return degrees;
}

class AcclaimWriter {
 public:
  AcclaimWriter(const std::filesystem::path& path, const Motion& motion);
  std::string asf() const;
  std::string amc() const;

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
    throw FormatError({path_}, "cannot be written as Acclaim: the motion has " + problem, remedy);
  }
  void check() const;
  void make_bones();
  void make_unique_names();
  Vec3 bone_of(int joint) const;
  int add_fixed_bone(const std::string& name, int parent, const Vec3& vector);
  int add_joint(int index, int parent, const OffsetTrack* track);
  Joint turning_of(int joint) const;
  void append_channels(std::string& text, const Bone& bone) const;
  void append_bone(std::string& text, std::size_t index) const;
  void append_hierarchy(std::string& text) const;
  void append_frame(std::string& text, int frame, std::vector<std::array<double, 3>>& angles) const;
  Vec3 translation(const Bone& bone, int frame) const;
  bool has_translation(const Bone& bone) const { return bone.joint == 0 || bone.track != nullptr; }

  std::filesystem::path path_;
  const Motion& motion_;
  const Skeleton& skeleton_;
  Mat3 R_preset_;  // the root's `orientation`, by which the skeleton's frames are turned
  std::vector<Bone> bones_;
};

AcclaimWriter::AcclaimWriter(const std::filesystem::path& path, const Motion& motion)
    : path_(path), motion_(motion), skeleton_(motion.skeleton) {
  check();
  R_preset_ = skeleton_.joint(0).R_joint_axes;
  make_bones();
  make_unique_names();
}

void AcclaimWriter::check() const {
  if (skeleton_.num_joints() == 0) refuse("no joints", "give it a skeleton");
  if (!(motion_.frame_time_s >= kShortestFrame_s && motion_.frame_time_s <= kLongestFrame_s))
    refuse("a frame time of " + std::to_string(motion_.frame_time_s) +
               " s, which must be from 0.0001 to 1 s",
           "resample it");
  const auto is_place = [](const Vec3& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxLength_m;
  };
  const auto is_fine = [](const Quat& q) { return q.coeffs().allFinite(); };
  bool has_places = std::ranges::all_of(motion_.root_positions, is_place);
  for (const auto& joint : skeleton_.joints())
    has_places = has_places && is_place(joint.bone) && is_place(joint.offset_parent);
  for (const auto& track : motion_.offset_tracks)
    has_places = has_places && std::ranges::all_of(track.offset_parent, is_place);
  if (!has_places || !std::ranges::all_of(motion_.rotations, is_fine))
    refuse("a length or a rotation that is not finite, or a position beyond 100 km",
           "remove those frames");
}

void AcclaimWriter::make_bones() {
  std::vector<const OffsetTrack*> tracks(skeleton_.joints().size(), nullptr);
  for (const auto& track : motion_.offset_tracks)
    tracks[static_cast<std::size_t>(track.joint)] = &track;
  std::vector<int> bone_of_joint;  // at whose end the children are
  for (int j = 0; j < skeleton_.num_joints(); ++j) {
    const Joint& joint = skeleton_.joint(j);
    int parent = j == 0 ? -1 : bone_of_joint[static_cast<std::size_t>(joint.parent)];
    if (j > 0) {
      const Vec3 added = bone_of(joint.parent) - skeleton_.joint(joint.parent).bone;
      const Vec3 remaining = joint.offset_parent - added;
      if (!remaining.isZero(0.0))
        parent = add_fixed_bone(joint.name + "_offset", parent, remaining);
    }
    int last = add_joint(j, parent, j == 0 ? nullptr : tracks[static_cast<std::size_t>(j)]);
    if (j == 0 && !joint.bone.isZero(0.0)) last = add_fixed_bone("root_bone", last, joint.bone);
    bone_of_joint.push_back(last);
  }
}

// From the joint's pivot to where its bone ends in the file.
Vec3 AcclaimWriter::bone_of(int index) const {
  const Vec3& own = skeleton_.joint(index).bone;
  if (index == 0 || !own.isZero(0.0)) return own;
  const auto& joints = skeleton_.joints();
  const auto child = std::ranges::find_if(joints, [&](const Joint& joint) {
    return joint.parent == index && !joint.offset_parent.isZero(0.0);
  });
  return child == joints.end() ? own : child->offset_parent;
}

int AcclaimWriter::add_fixed_bone(const std::string& name, int parent, const Vec3& vector) {
  Bone bone;
  bone.name = name;
  bone.parent = parent;
  bone.vector = R_preset_.transpose() * vector;
  bones_.push_back(std::move(bone));
  return static_cast<int>(bones_.size()) - 1;
}

int AcclaimWriter::add_joint(int index, int parent, const OffsetTrack* track) {
  const Joint& joint = skeleton_.joint(index);
  const int added = add_fixed_bone(index == 0 ? "root" : joint.name, parent, bone_of(index));
  auto& bone = bones_.back();
  bone.turning = turning_of(index);
  bone.joint = index;
  bone.track = track;
  bone.offset = joint.offset_parent;
  return added;
}

// The joint's own axes where they reach all of its rotations, else three.
Joint AcclaimWriter::turning_of(int index) const {
  const Joint& joint = skeleton_.joint(index);
  Joint turning;
  turning.R_joint_axes = joint.R_joint_axes;
  turning.axes = joint.axes;
  const bool repeats = joint.axes.size() == 2 && joint.axes[0] == joint.axes[1];
  bool is_reached = !repeats;
  std::array<double, 3> angles{};
  for (int frame = 0; is_reached && joint.axes.size() < 3 && frame < motion_.num_frames();
       ++frame) {
    const Mat3 R = motion_.rotation(frame, index).toRotationMatrix();
    const auto previous = angles;
    joint_angles(turning, R, previous.data(), angles.data());
    is_reached =
        (joint_rotation(turning, angles.data()) - R).cwiseAbs().maxCoeff() <= kSameRotation;
  }
  if (!is_reached) turning.axes = {Axis::z, Axis::y, Axis::x};
  return turning;
}

// The joints keep their names before the bones that are made for them.
void AcclaimWriter::make_unique_names() {
  std::vector<std::string> names{"root"};
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < bones_.size(); ++i)
    if (bones_[i].joint >= 0) order.push_back(i);
  for (std::size_t i = 1; i < bones_.size(); ++i)
    if (bones_[i].joint < 0) order.push_back(i);
  for (const auto i : order) names.push_back(writable_name(bones_[i].name));
  names = unique_names(std::move(names), NameCase::ignored);
  for (std::size_t i = 0; i < order.size(); ++i) bones_[order[i]].name = std::move(names[i + 1]);
}

std::string AcclaimWriter::asf() const {
  std::string text =
      "# Acclaim skeleton written by Sparse Mocap\n:version 1.10\n:name skeleton\n:units\n"
      "  mass 1.0\n  length 0.45\n  angle deg\n:documentation\n  Lengths in inches / 0.45.\n"
      ":root\n  order";
  append_channels(text, bones_[0]);
  text += "\n  axis XYZ\n  position 0 0 0\n  orientation";
  for (const double angle : xyz_angles(R_preset_)) append_digits(text, angle);
  text += "\n:bonedata\n";
  for (std::size_t i = 1; i < bones_.size(); ++i) append_bone(text, i);
  append_hierarchy(text);
  return text;
}

// What turns first (the innermost axis) comes first.
void AcclaimWriter::append_channels(std::string& text, const Bone& bone) const {
  const bool is_root = bone.joint == 0;
  if (has_translation(bone)) text += is_root ? " TX TY TZ" : " tx ty tz";
  for (auto axis = bone.turning.axes.rbegin(); axis != bone.turning.axes.rend(); ++axis) {
    text += is_root ? " R" : " r";
    text += static_cast<char>((is_root ? 'X' : 'x') + static_cast<int>(*axis));
  }
}

void AcclaimWriter::append_bone(std::string& text, std::size_t index) const {
  const auto& bone = bones_[index];
  const double length = bone.vector.norm();
  const Vec3 direction = length > 0.0 ? Vec3(bone.vector / length) : Vec3::UnitZ();
  text += "  begin\n    id " + std::to_string(index) + "\n    name " + bone.name;
  text += "\n    direction";
  for (const double value : direction) append_digits(text, value);
  text += "\n    length";
  append_digits(text, length * kUnitsPerMetre);
  text += "\n    axis";
  const Mat3 axes = bone.joint < 0 ? Mat3(Mat3::Identity())
                                   : Mat3(R_preset_.transpose() * bone.turning.R_joint_axes);
  for (const double angle : xyz_angles(axes)) append_digits(text, angle);
  text += " XYZ\n";
  const auto num_channels = bone.turning.axes.size() + (has_translation(bone) ? 3 : 0);
  if (num_channels > 0) {
    text += "    dof";
    append_channels(text, bone);
    text += "\n    limits (-inf inf)\n";
    for (std::size_t i = 1; i < num_channels; ++i) text += "           (-inf inf)\n";
  }
  text += "  end\n";
}

void AcclaimWriter::append_hierarchy(std::string& text) const {
  std::vector<std::string> lines(bones_.size());
  for (std::size_t i = 1; i < bones_.size(); ++i)
    lines[static_cast<std::size_t>(bones_[i].parent)] += " " + bones_[i].name;
  text += ":hierarchy\n  begin\n";
  for (std::size_t i = 0; i < bones_.size(); ++i)
    if (!lines[i].empty()) text += "    " + bones_[i].name + lines[i] + "\n";
  text += "  end\n";
}

std::string AcclaimWriter::amc() const {
  std::string text = "#!OML:ASF\n:FULLY-SPECIFIED\n:SAMPLES-PER-SECOND";
  append_digits(text, 1.0 / motion_.frame_time_s);
  text += "\n:DEGREES\n";
  std::vector<std::array<double, 3>> angles(bones_.size());
  for (int frame = 0; frame < motion_.num_frames(); ++frame) append_frame(text, frame, angles);
  return text;
}

// angles: of every bone, on entry in the frame before, on return in this one.
void AcclaimWriter::append_frame(std::string& text, int frame,
                                 std::vector<std::array<double, 3>>& angles) const {
  text += std::to_string(frame + 1) + "\n";
  for (std::size_t i = 0; i < bones_.size(); ++i) {
    const auto& bone = bones_[i];
    const auto& axes = bone.turning.axes;
    if (bone.joint < 0 || (axes.empty() && !has_translation(bone))) continue;
    text += bone.name;
    if (has_translation(bone))
      for (const double value : translation(bone, frame))
        append_decimals(text, value * kUnitsPerMetre);
    const auto previous = angles[i];
    joint_angles(bone.turning, motion_.rotation(frame, bone.joint).toRotationMatrix(),
                 previous.data(), angles[i].data());
    for (std::size_t k = axes.size(); k-- > 0;)
      append_decimals(text, angles[i][k] / kRadiansPerDegree);
    text += '\n';
  }
}

Vec3 AcclaimWriter::translation(const Bone& bone, int frame) const {
  const auto f = static_cast<std::size_t>(frame);
  if (bone.joint == 0) return motion_.root_positions[f];
  return bone.turning.R_joint_axes.transpose() * (bone.track->offset_parent[f] - bone.offset);
}

}  // namespace

void write_acclaim(const std::filesystem::path& amc_path, const Motion& motion) {
  const AcclaimWriter writer(amc_path, motion);
  const auto asf = writer.asf();
  const auto amc = writer.amc();
  auto asf_path = amc_path;
  write_file_atomically(asf_path.replace_extension(".asf"), asf);
  write_file_atomically(amc_path, amc);
}

}  // namespace sparse_mocap
