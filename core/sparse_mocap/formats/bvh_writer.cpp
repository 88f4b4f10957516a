// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/formats/reader_support.hpp"

namespace sparse_mocap {
namespace {

constexpr double kUnitsPerMetre = 100.0;
constexpr int kDecimals = 6;  // 1e-8 m and 2e-8 rad
constexpr std::array<Axis, 3> kAngleOrder{Axis::z, Axis::y, Axis::x};

void append_number(std::string& text, double value) {
  std::array<char, 64> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::fixed, kDecimals);
  text += ' ';
  text.append(digits.data(), error == std::errc{} ? end : digits.data());
}

void append_lengths(std::string& text, const Vec3& lengths_m) {
  for (const double length : lengths_m) append_number(text, length * kUnitsPerMetre);
}

// Names without spaces, which readers would split.
std::vector<std::string> writable_names(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const auto& joint : skeleton.joints()) {
    names.push_back(joint.name);
    for (char& c : names.back()) {
      const bool is_blank_or_control = static_cast<unsigned char>(c) <= ' ' || c == '\x7F';
      if (is_blank_or_control || c == '{' || c == '}') c = '_';
    }
  }
  return unique_names(std::move(names));
}

class BvhWriter {
 public:
  explicit BvhWriter(const Motion& motion);
  std::string text();

 private:
  std::size_t num_joints() const { return skeleton_.joints().size(); }
  void append_hierarchy();
  void open_joint(int index, const std::string& indent);
  void append_end_site(int index, const std::string& indent);
  void append_frame(int frame);
  // From the pivot of a joint's parent to its pivot, in the parent's frame.
  Vec3 offset(int index, const Vec3& offset_parent) const {
    const int parent = skeleton_.joint(index).parent;
    return parent < 0 ? offset_parent : skeleton_.joint(parent).bone + offset_parent;
  }

  const Motion& motion_;
  const Skeleton& skeleton_;
  Joint zyx_;  // turns about z, y and x of its own frame
  std::vector<std::string> names_;
  std::vector<std::vector<int>> children_;
  std::vector<int> column_order_;              // the joints depth first
  std::vector<const OffsetTrack*> tracks_;     // of every joint, may be null
  std::vector<std::array<double, 3>> angles_;  // of every joint in the previous frame, rad
  std::string text_;
};

BvhWriter::BvhWriter(const Motion& motion)
    : motion_(motion),
      skeleton_(motion.skeleton),
      names_(writable_names(motion.skeleton)),
      children_(num_joints()),
      tracks_(num_joints(), nullptr),
      angles_(num_joints()) {
  zyx_.axes.assign(kAngleOrder.begin(), kAngleOrder.end());
  for (int j = 1; j < skeleton_.num_joints(); ++j)
    children_[static_cast<std::size_t>(skeleton_.joint(j).parent)].push_back(j);
  for (const auto& track : motion.offset_tracks)
    if (track.joint > 0) tracks_[static_cast<std::size_t>(track.joint)] = &track;
}

std::string BvhWriter::text() {
  text_ = "HIERARCHY\n";
  if (num_joints() > 0) append_hierarchy();
  text_ += "MOTION\nFrames: " + std::to_string(motion_.num_frames()) + "\nFrame Time: ";
  std::array<char, 32> digits{};
  text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(),
                                            motion_.frame_time_s, std::chars_format::fixed)
                                  .ptr);
  text_ += '\n';
  for (int frame = 0; frame < motion_.num_frames(); ++frame) append_frame(frame);
  return std::move(text_);
}

void BvhWriter::append_hierarchy() {
  struct Step {
    int joint;
    std::size_t depth;
    bool is_closing;
  };
  std::vector<Step> steps{{0, 0, false}};
  while (!steps.empty()) {
    const auto [joint, depth, is_closing] = steps.back();
    steps.pop_back();
    const std::string indent(depth, '\t');
    if (is_closing) {
      text_ += indent + "}\n";
      continue;
    }
    open_joint(joint, indent);
    steps.push_back({joint, depth, true});
    const auto& children = children_[static_cast<std::size_t>(joint)];
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      steps.push_back({*child, depth + 1, false});
  }
}

void BvhWriter::open_joint(int index, const std::string& indent) {
  const auto j = static_cast<std::size_t>(index);
  column_order_.push_back(index);
  text_ += indent + (index == 0 ? "ROOT " : "JOINT ") + names_[j] + "\n" + indent + "{\n";
  text_ += indent + "\tOFFSET";
  append_lengths(text_, offset(index, skeleton_.joint(index).offset_parent));
  text_ += "\n" + indent;
  const bool has_positions = index == 0 || tracks_[j] != nullptr;
  text_ += has_positions ? "\tCHANNELS 6 Xposition Yposition Zposition" : "\tCHANNELS 3";
  text_ += " Zrotation Yrotation Xrotation\n";
  if (children_[j].empty()) append_end_site(index, indent + "\t");
}

void BvhWriter::append_end_site(int index, const std::string& indent) {
  text_ += indent + "End Site\n" + indent + "{\n" + indent + "\tOFFSET";
  append_lengths(text_, skeleton_.joint(index).bone);
  text_ += "\n" + indent + "}\n";
}

void BvhWriter::append_frame(int frame) {
  const auto row_begin = text_.size();
  for (const int index : column_order_) {
    const auto j = static_cast<std::size_t>(index);
    const auto f = static_cast<std::size_t>(frame);
    if (index == 0) append_lengths(text_, motion_.root_positions[f]);
    if (tracks_[j] != nullptr) append_lengths(text_, offset(index, tracks_[j]->offset_parent[f]));
    const auto previous = angles_[j];
    joint_angles(zyx_, motion_.rotation(frame, index).toRotationMatrix(), previous.data(),
                 angles_[j].data());
    for (const double angle : angles_[j]) append_number(text_, angle / kRadiansPerDegree);
  }
  text_.erase(row_begin, 1);  // the blank before the first number
  text_ += '\n';
}

}  // namespace

void write_bvh(const std::filesystem::path& path, const Motion& motion) {
  write_file_atomically(path, BvhWriter(motion).text());
}

}  // namespace sparse_mocap
