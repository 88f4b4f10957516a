// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/joint_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace sparse_mocap {
namespace {

// The names under which exporters know a part, the least ambiguous first. A new exporter is a new
// word here.
struct PartNames {
  BodyPart part;
  std::string_view names;
};

constexpr std::array<PartNames, kNumBodyParts> kPartNames{{
    {BodyPart::thigh, "upleg upperleg upperleg01 thigh uleg hip leg femur"},
    {BodyPart::shank, "lowleg loleg lowerleg lowerleg01 shin calf knee leg tibia"},
    {BodyPart::foot, "foot ankle"},
    {BodyPart::upper_arm, "uparm upperarm upperarm01 uarm shldr arm bicep shoulder humerus"},
    {BodyPart::forearm, "forearm lowarm loarm lowerarm lowerarm01 farm elbow radius"},
    {BodyPart::hand, "wrist hand"},
    {BodyPart::head, "head skull"},
}};

// Words that exporters add to every name.
constexpr std::string_view kIgnored =
    " jnt joint bone bip bip01 bip001 def org fk rig mixamorig character1 valve biped cc base bend "
    "stretch b bn c j m x ";

bool is_ignored(const std::string& word) {
  return kIgnored.find(" " + word + " ") != std::string_view::npos;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
char lowered(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Lower-case words: split at separators and at capitals that follow a small letter or a digit.
std::vector<std::string> words_of(std::string_view name) {
  const auto colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_part = is_letter(name[i]) || is_digit(name[i]);
    const bool is_start = is_upper(name[i]) && i > 0 && !is_upper(name[i - 1]);
    if ((!is_part || is_start) && !words.back().empty()) words.emplace_back();
    if (is_part) words.back().push_back(lowered(name[i]));
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

int rank_of(BodyPart part, const std::string& plain) {
  std::istringstream names{std::string(kPartNames[static_cast<std::size_t>(part)].names)};
  std::string name;
  for (int rank = 0; names >> name; ++rank)
    if (name == plain) return rank;
  return -1;
}

bool is_known(const std::string& plain) {
  return std::any_of(kPartNames.begin(), kPartNames.end(),
                     [&](const PartNames& entry) { return rank_of(entry.part, plain) >= 0; });
}

// A side glued to the part: "leftupleg", "lfemur".
void split_glued_side(std::string& plain, Side& side) {
  for (const auto& [word, of] : {std::pair{"left", Side::left}, std::pair{"right", Side::right},
                                 std::pair{"l", Side::left}, std::pair{"r", Side::right}}) {
    if (!plain.starts_with(word)) continue;
    const std::string rest = plain.substr(std::string_view(word).size());
    if (!is_known(rest)) continue;
    plain = rest;
    side = of;
    return;
  }
}

}  // namespace

std::string plain_part_name(std::string_view name, Side& side) {
  side = Side::middle;
  std::string plain;
  for (const auto& word : words_of(name)) {
    if (word == "l" || word == "left") {
      side = Side::left;
    } else if (word == "r" || word == "right") {
      side = Side::right;
    } else if (!is_ignored(word)) {
      plain += word;
    }
  }
  if (side == Side::middle) split_glued_side(plain, side);
  return plain;
}

std::vector<NamedPart> parts_named(std::string_view name) {
  Side side = Side::middle;
  const std::string plain = plain_part_name(name, side);
  std::vector<NamedPart> parts;
  for (const auto& entry : kPartNames) {
    const int rank = rank_of(entry.part, plain);
    if (rank < 0 || (entry.part == BodyPart::head) != (side == Side::middle)) continue;
    // Helper joints ("__lThigh") come after the joint itself.
    parts.push_back({entry.part, side, 2 * rank + (name.starts_with("__") ? 1 : 0)});
  }
  return parts;
}

}  // namespace sparse_mocap
