// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/reader_support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/formats/other_formats.hpp"

namespace sparse_mocap {
namespace {

constexpr std::size_t kMaxNameBytes = 255;

// The bytes of the UTF-8 character at the start of text, 0 when it is not one.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t length = 0;
  if (byte(0) < 0x80) length = 1;
  if (byte(0) >= 0xC2 && byte(0) <= 0xDF) length = 2;
  if (byte(0) >= 0xE0 && byte(0) <= 0xEF) length = 3;
  if (byte(0) >= 0xF0 && byte(0) <= 0xF4) length = 4;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool is_overlong =
      (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool is_surrogate = byte(0) == 0xED && byte(1) > 0x9F;
  const bool is_beyond_unicode = byte(0) == 0xF4 && byte(1) > 0x8F;
  return is_overlong || is_surrogate || is_beyond_unicode ? 0 : length;
}

// The longest side of the box around the figure: height or span of the arms.
double size_m(const JointTransforms& pose) {
  Eigen::AlignedBox3d box;
  for (const auto& point : pose.pivot) box.extend(point);
  for (const auto& point : pose.end) box.extend(point);
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

// A warning's text without quotations and digits.
std::string kind_of(std::string_view text) {
  std::string kind;
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted && (c < '0' || c > '9')) kind += c;
  }
  return kind;
}

}  // namespace

Quat turned_about(const Quat& q, Axis axis, double angle_rad) {
  const auto i = static_cast<Eigen::Index>(axis);
  const Eigen::Index j = i == 2 ? 0 : i + 1;
  const Eigen::Index k = j == 2 ? 0 : j + 1;
  const double s = std::sin(0.5 * angle_rad);
  const double c = std::cos(0.5 * angle_rad);
  const auto& from = q.coeffs();  // x y z w
  Quat result;
  auto& to = result.coeffs();
  to[3] = c * from[3] - s * from[i];
  to[i] = c * from[i] + s * from[3];
  to[j] = c * from[j] + s * from[k];
  to[k] = c * from[k] - s * from[j];
  return result;
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string escaped_to_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto length = utf8_length(text);
    if (length > 0) {
      result += text.substr(0, length);
    } else {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned char>(text[0]));
      result += escape.data();
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

void add_warning(std::vector<ReadWarning>& warnings, const FileLocation& location,
                 const std::string& text) {
  const auto kind = kind_of(text);
  const auto known = std::ranges::find_if(
      warnings, [&](const ReadWarning& warning) { return kind_of(warning.text) == kind; });
  if (known == warnings.end()) {
    warnings.push_back({location, text});
  } else {
    ++known->count;
  }
}

double length_m(TextScanner& scanner, std::string_view what, double unit_m) {
  const auto token = scanner.peek();
  const double length = scanner.number(what) * unit_m;
  if (std::abs(length) > kMaxLength_m)
    scanner.fail(token,
                 in_quotes(token) + " is " + short_number(length) + " m, which cannot be a length",
                 "check the number and the unit of the file");
  return length;
}

Vec3 lengths_m(TextScanner& scanner, std::string_view what, double unit_m) {
  Vec3 lengths;
  for (double& length : lengths) length = length_m(scanner, what, unit_m);
  return lengths;
}

std::string checked_name(const TextScanner& scanner, std::string_view token, std::string_view name,
                         std::vector<ReadWarning>& warnings) {
  if (name.size() > kMaxNameBytes)
    scanner.fail(token,
                 "a name has " + std::to_string(name.size()) + " bytes, at most " +
                     std::to_string(kMaxNameBytes) + " are accepted",
                 "shorten it");
  auto usable = escaped_to_utf8(name);
  if (usable != name)
    add_warning(warnings, scanner.location(token),
                "the name is not UTF-8; read as " + in_quotes(usable));
  return usable;
}

std::vector<std::string> unique_names(std::vector<std::string> names, NameCase name_case) {
  const auto key = [&](const std::string& name) {
    return name_case == NameCase::ignored ? lower_case(name) : name;
  };
  std::set<std::string> originals;
  for (const auto& name : names) originals.insert(key(name));
  std::set<std::string> taken;
  for (auto& name : names) {
    std::string candidate = name;
    for (int number = 2; taken.contains(key(candidate)) ||
                         (candidate != name && originals.contains(key(candidate)));
         ++number)
      candidate = name + "_" + std::to_string(number);
    taken.insert(key(candidate));
    name = std::move(candidate);
  }
  return names;
}

void warn_about_size(const JointTransforms& pose, const FileLocation& location,
                     std::vector<ReadWarning>& warnings) {
  constexpr double kSmallest_m = 0.5;
  constexpr double kTallest_m = 3.0;
  const double size = size_m(pose);
  if (size == 0.0 || (size >= kSmallest_m && size <= kTallest_m)) return;
  add_warning(warnings, location,
              "the figure measures " + short_number(size) +
                  " m; if that is not its size, choose the file's unit");
}

Quat rotation_to_y(Axis up) {
  if (up == Axis::y) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(up == Axis::z ? -0.5 * kPi : 0.5 * kPi,
                                up == Axis::z ? Vec3::UnitX() : Vec3::UnitZ()));
}

void change_world(Motion& motion, double factor, const Quat& R_new_old) {
  const auto changed = [&](const Vec3& v) -> Vec3 { return factor * (R_new_old * v); };
  auto joints = motion.skeleton.joints();
  for (auto& joint : joints) {
    joint.offset_parent = changed(joint.offset_parent);
    joint.bone = changed(joint.bone);
    joint.R_joint_axes = R_new_old * joint.R_joint_axes;
  }
  motion.skeleton = Skeleton(std::move(joints));
  for (auto& position : motion.root_positions) position = changed(position);
  for (auto& rotation : motion.rotations) rotation = R_new_old * rotation * R_new_old.conjugate();
  for (auto& track : motion.offset_tracks)
    for (auto& offset : track.offset_parent) offset = changed(offset);
}

std::string read_motion_text(const std::filesystem::path& path, const ReadOptions& options) {
  std::string text = read_file(path, options.max_bytes);
  if (const auto* other = other_format_by_content(text))
    throw FormatError({path}, other->what, other->remedy);
  // Of a file of zero bytes alone, or of UTF-16, some stay for the scanner to refuse.
  const std::size_t end = text.find_last_not_of(std::string_view("\0\x1a \t\r\n", 6));
  const std::string_view tail =
      std::string_view(text).substr(end == std::string::npos ? text.size() : end + 1);
  if (tail.find_first_of(std::string_view("\0\x1a", 2)) != std::string_view::npos)
    text.resize(end + 1);
  return text;
}

int max_frames_of(int num_joints, const ReadOptions& options) {
  const auto by_memory = options.max_rotations / static_cast<std::size_t>(std::max(1, num_joints));
  return static_cast<int>(std::min(by_memory, static_cast<std::size_t>(options.max_frames)));
}

}  // namespace sparse_mocap
