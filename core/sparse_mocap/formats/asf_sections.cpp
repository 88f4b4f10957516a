// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/asf_sections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparse_mocap {
namespace {

// Remedies in error messages.
constexpr const char* kExportAgain = "the file may be cut off; export it again";
constexpr const char* kRemoveOne = "remove one of them";
constexpr const char* kRename = "give it another name";

constexpr double kUnitTolerance = 1e-3;  // directions usually have six digits

struct ChannelName {
  std::string_view name;
  AcclaimChannel channel;
};

constexpr std::array<ChannelName, 7> kChannelNames{{{"rx", AcclaimChannel::rx},
                                                    {"ry", AcclaimChannel::ry},
                                                    {"rz", AcclaimChannel::rz},
                                                    {"tx", AcclaimChannel::tx},
                                                    {"ty", AcclaimChannel::ty},
                                                    {"tz", AcclaimChannel::tz},
                                                    {"l", AcclaimChannel::length}}};

bool is_word(std::string_view token, std::string_view word) {
  return equal_ignoring_case(token, word);
}

// A number, or one of the infinities that limits may be.
bool is_limit(std::string_view token) {
  double ignored = 0.0;
  if (parse_number(token, ignored) != NumberStatus::malformed) return true;
  if (token.starts_with('-') || token.starts_with('+')) token.remove_prefix(1);
  return is_word(token, "inf") || is_word(token, "infinity") || is_word(token, "1.#inf");
}

class SectionReader {
 public:
  SectionReader(TextScanner& scanner, const ReadOptions& options,
                std::vector<ReadWarning>& warnings)
      : scanner_(scanner), options_(options), warnings_(warnings) {}

  AsfSections read();

 private:
  void read_section(std::string_view keyword);
  bool in_section();
  void skip_section();
  void read_units();
  void read_root();
  void read_bones();
  void read_bone(std::string_view begin);
  void read_bone_item(std::string_view key, AsfBone& bone);
  void check_bone(AsfBone& bone, std::string_view begin);
  void read_limits(std::string_view key, AsfBone& bone);
  void check_limits(const AsfBone& bone);
  void read_hierarchy();
  std::vector<AcclaimChannel> read_channels(bool is_root);
  std::array<Axis, 3> read_axis_order();
  Vec3 read_vector(std::string_view what);
  void expect_word(std::string_view word);
  void skip_unknown(std::string_view key, std::string_view section);
  void warn(std::string_view token, const std::string& text) {
    add_warning(warnings_, scanner_.location(token), text);
  }

  TextScanner& scanner_;
  const ReadOptions& options_;
  std::vector<ReadWarning>& warnings_;
  AsfSections sections_;
  bool has_units_ = false;
  bool has_root_ = false;
  bool has_bones_ = false;
  bool has_hierarchy_ = false;
};

AsfSections SectionReader::read() {
  if (scanner_.at_end()) scanner_.fail(scanner_.here(), "the file is empty", "export it again");
  while (!scanner_.at_end()) {
    const auto keyword = scanner_.next();
    if (keyword[0] != ':' || !scanner_.starts_line(keyword))
      scanner_.fail(keyword, "expected a section such as :units, got " + in_quotes(keyword),
                    "choose an .asf file");
    read_section(keyword);
  }
  const auto end = scanner_.here();
  if (!has_root_) scanner_.fail(end, "there is no :root section", kExportAgain);
  if (!has_bones_) scanner_.fail(end, "there is no :bonedata section", kExportAgain);
  if (!has_hierarchy_) scanner_.fail(end, "there is no :hierarchy section", kExportAgain);
  if (!has_units_) warn(end, "there is no :units section; inches and degrees are assumed");
  return std::move(sections_);
}

void SectionReader::read_section(std::string_view keyword) {
  const auto begin_once = [&](bool& has_it) {
    if (has_it) scanner_.fail(keyword, "a second section " + in_quotes(keyword), kRemoveOne);
    has_it = true;
  };
  if (is_word(keyword, ":units")) {
    begin_once(has_units_);
    read_units();
  } else if (is_word(keyword, ":root")) {
    begin_once(has_root_);
    read_root();
  } else if (is_word(keyword, ":bonedata")) {
    begin_once(has_bones_);
    read_bones();
  } else if (is_word(keyword, ":hierarchy")) {
    begin_once(has_hierarchy_);
    read_hierarchy();
  } else {
    // :version, :name, :documentation, :skin and others are not needed for the motion.
    skip_section();
  }
}

bool SectionReader::in_section() {
  if (scanner_.at_end()) return false;
  const auto token = scanner_.peek();
  return token[0] != ':' || !scanner_.starts_line(token);
}

void SectionReader::skip_section() {
  scanner_.rest_of_line();
  while (in_section()) scanner_.rest_of_line();
}

void SectionReader::skip_unknown(std::string_view key, std::string_view section) {
  warn(key, in_quotes(key) + " is unknown in " + std::string(section) + "; it is ignored");
  scanner_.rest_of_line();
}

void SectionReader::read_units() {
  while (in_section()) {
    const auto key = scanner_.next();
    if (is_word(key, "length")) {
      sections_.length_unit = scanner_.number("a number after length");
      if (!(sections_.length_unit > 1e-6 && sections_.length_unit < 1e6))
        scanner_.fail(key, "the unit of length must be positive", "0.45 is usual, 1 means inches");
    } else if (is_word(key, "angle")) {
      const auto unit = scanner_.next_on_line();
      const bool is_radian = is_word(unit, "rad") || is_word(unit, "radians");
      if (!is_radian && !is_word(unit, "deg") && !is_word(unit, "degrees"))
        scanner_.fail(unit, "expected deg or rad after angle, got " + in_quotes(unit),
                      "write angle deg or angle rad");
      sections_.is_in_degrees = !is_radian;
    } else if (is_word(key, "mass")) {
      scanner_.number("a number after mass");
    } else {
      skip_unknown(key, ":units");
    }
  }
}

void SectionReader::read_root() {
  auto& root = sections_.root;
  while (in_section()) {
    const auto key = scanner_.next();
    if (is_word(key, "order")) {
      root.channels = read_channels(true);
    } else if (is_word(key, "axis")) {
      root.axis_order = read_axis_order();
    } else if (is_word(key, "position")) {
      root.position = read_vector("3 numbers after position");
      root.position_key = key;
    } else if (is_word(key, "orientation")) {
      root.orientation_angles = read_vector("3 numbers after orientation");
    } else {
      skip_unknown(key, ":root");
    }
  }
  if (!root.channels.empty()) return;
  warn(scanner_.here(), ":root has no order; TX TY TZ RX RY RZ is assumed");
  root.channels = {AcclaimChannel::tx, AcclaimChannel::ty, AcclaimChannel::tz,
                   AcclaimChannel::rx, AcclaimChannel::ry, AcclaimChannel::rz};
}

Vec3 SectionReader::read_vector(std::string_view what) {
  Vec3 vector;
  for (double& value : vector) value = scanner_.number(what);
  return vector;
}

std::array<Axis, 3> SectionReader::read_axis_order() {
  const auto token = scanner_.next_on_line();
  const auto letters = lower_case(token);
  auto sorted = letters;
  std::ranges::sort(sorted);
  if (sorted != "xyz")
    scanner_.fail(token, "expected an order of rotations such as XYZ, got " + in_quotes(token),
                  "name each of X, Y and Z once");
  std::array<Axis, 3> order{};
  for (std::size_t i = 0; i < 3; ++i) order[i] = static_cast<Axis>(letters[i] - 'x');
  return order;
}

std::vector<AcclaimChannel> SectionReader::read_channels(bool is_root) {
  std::vector<AcclaimChannel> channels;
  while (!scanner_.at_line_end()) {
    const auto token = scanner_.next();
    const auto* known =
        std::ranges::find_if(kChannelNames, [&](const auto& c) { return is_word(token, c.name); });
    if (known == kChannelNames.end() || (is_root && known->channel == AcclaimChannel::length))
      scanner_.fail(token, "unknown channel " + in_quotes(token),
                    "use rx, ry, rz, tx, ty, tz or l");
    if (std::ranges::count(channels, known->channel) > 0)
      scanner_.fail(token, "channel " + in_quotes(token) + " is listed twice", kRemoveOne);
    channels.push_back(known->channel);
  }
  return channels;
}

void SectionReader::expect_word(std::string_view word) {
  const auto token = scanner_.next();
  if (is_word(token, word)) return;
  const std::string got = token.empty() ? "but the file ends" : "got " + in_quotes(token);
  scanner_.fail(token, "expected " + std::string(word) + ", " + got, "each begin has an end");
}

void SectionReader::read_bones() {
  while (in_section()) {
    const auto begin = scanner_.peek();
    expect_word("begin");
    if (static_cast<int>(sections_.bones.size()) + 1 >= options_.max_joints)
      scanner_.fail(begin, "there are more than " + std::to_string(options_.max_joints) + " bones",
                    "raise the limit max_joints if that is intended");
    read_bone(begin);
  }
}

void SectionReader::read_bone(std::string_view begin) {
  AsfBone bone;
  bone.token = begin;
  while (in_section()) {
    const auto key = scanner_.next();
    if (is_word(key, "end")) {
      check_bone(bone, begin);
      check_limits(bone);
      sections_.bones.push_back(std::move(bone));
      return;
    }
    read_bone_item(key, bone);
  }
  scanner_.fail(scanner_.here(),
                "the bone that begins in line " + std::to_string(scanner_.location(begin).line) +
                    " has no end",
                "the file may be cut off, or a line end is missing");
}

void SectionReader::read_bone_item(std::string_view key, AsfBone& bone) {
  if (is_word(key, "name")) {
    bone.token = scanner_.next_on_line();
    bone.name = checked_name(scanner_, bone.token, bone.token, warnings_);
  } else if (is_word(key, "direction")) {
    bone.direction = read_vector("3 numbers after direction");
  } else if (is_word(key, "length")) {
    const auto token = scanner_.peek();
    bone.length = scanner_.number("a number after length");
    if (bone.length < 0)
      scanner_.fail(token, "the length of a bone is negative", "reverse its direction instead");
  } else if (is_word(key, "axis")) {
    bone.axis_angles = read_vector("3 numbers after axis");
    bone.axis_order = read_axis_order();
  } else if (is_word(key, "dof")) {
    bone.channels = read_channels(false);
  } else if (is_word(key, "limits")) {
    read_limits(key, bone);
  } else if (is_word(key, "id") || is_word(key, "bodymass") || is_word(key, "cofmass")) {
    scanner_.rest_of_line();
  } else {
    skip_unknown(key, ":bonedata");
  }
}

void SectionReader::check_bone(AsfBone& bone, std::string_view begin) {
  if (bone.name.empty()) scanner_.fail(begin, "a bone has no name", "add a line with its name");
  if (is_word(bone.name, "root")) scanner_.fail(bone.token, "a bone cannot be named root", kRename);
  const double norm = bone.direction.stableNorm();
  if (norm == 0.0) {
    if (bone.length > 0.0)
      scanner_.fail(bone.token, "the direction of bone " + in_quotes(bone.name) + " is zero",
                    "give it a direction, or the length 0");
    return;
  }
  if (std::abs(norm - 1.0) <= kUnitTolerance) return;
  bone.direction.stableNormalize();
  warn(bone.token,
       "the direction of bone " + in_quotes(bone.name) + " is not a unit vector; it is normalised");
}

// Pairs of numbers, one for each channel, on any number of lines.
void SectionReader::read_limits(std::string_view key, AsfBone& bone) {
  bone.limits = key;
  bone.num_limits = 0;
  while (is_limit(scanner_.peek())) {
    scanner_.next();
    ++bone.num_limits;
  }
}

void SectionReader::check_limits(const AsfBone& bone) {
  if (bone.limits.empty() || bone.num_limits == 2 * bone.channels.size()) return;
  warn(bone.limits, "bone " + in_quotes(bone.name) + " has " + std::to_string(bone.num_limits) +
                        " limits for " + std::to_string(bone.channels.size()) + " channels");
}

void SectionReader::read_hierarchy() {
  expect_word("begin");
  while (in_section()) {
    AsfFamily family;
    family.parent = scanner_.next();
    if (is_word(family.parent, "end") && scanner_.at_line_end()) return;
    while (!scanner_.at_line_end()) family.children.push_back(scanner_.next());
    sections_.families.push_back(std::move(family));
  }
  scanner_.fail(scanner_.here(), "the :hierarchy section has no end", kExportAgain);
}

}  // namespace

AsfSections read_asf_sections(TextScanner& scanner, const ReadOptions& options,
                              std::vector<ReadWarning>& warnings) {
  return SectionReader(scanner, options, warnings).read();
}

}  // namespace sparse_mocap
