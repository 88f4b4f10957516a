// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/bvh_hierarchy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sparse_mocap {
namespace {

constexpr int kMaxChannels = 6;

// Remedies in error messages.
constexpr const char* kExportAgain = "the file may be cut off; export it again";
constexpr const char* kCheckBraces = "check the braces before it";
constexpr const char* kRemoveOne = "remove one of them";
constexpr const char* kCountChannels = "count the names of the channels";

struct ChannelName {
  std::string_view name;
  BvhChannel channel;
};

constexpr std::array<ChannelName, kMaxChannels> kChannelNames{{{"Xposition", {false, Axis::x}},
                                                               {"Yposition", {false, Axis::y}},
                                                               {"Zposition", {false, Axis::z}},
                                                               {"Xrotation", {true, Axis::x}},
                                                               {"Yrotation", {true, Axis::y}},
                                                               {"Zrotation", {true, Axis::z}}}};

const BvhChannel* find_channel(std::string_view token) {
  for (const auto& [name, channel] : kChannelNames)
    if (equal_ignoring_case(token, name)) return &channel;
  return nullptr;
}

bool is_word(std::string_view token, std::string_view word) {
  return equal_ignoring_case(token, word);
}

// An open pair of braces, of a joint or of its End Site.
struct OpenBlock {
  int joint = 0;
  bool is_end_site = false;
  bool has_offset = false;  // of an End Site
};

// Reads the tree. Open blocks are kept in a vector, so that deep files cannot overflow the call
// stack, and joints are referred to by index, since their vector grows.
class HierarchyReader {
 public:
  HierarchyReader(TextScanner& scanner, const ReadOptions& options,
                  std::vector<ReadWarning>& warnings)
      : scanner_(scanner), options_(options), warnings_(warnings) {}

  BvhHierarchy read();

 private:
  BvhJoint& joint(int index) { return joints_[static_cast<std::size_t>(index)]; }
  void read_outside_block(std::string_view token);
  void read_joint_item(std::string_view token);
  void read_end_site_item(std::string_view token);
  void open_joint(std::string_view keyword);
  void open_end_site();
  void close_block(std::string_view token);
  void push_block(std::string_view keyword, OpenBlock block);
  std::string read_name(std::string_view keyword);
  void expect_opening_brace(std::string_view after);
  void read_channels(std::string_view keyword);
  int read_channel_count();
  void warn(const FileLocation& location, const std::string& text) {
    add_warning(warnings_, location, text);
  }
  [[noreturn]] void fail_truncated(std::string_view token);

  TextScanner& scanner_;
  const ReadOptions& options_;
  std::vector<ReadWarning>& warnings_;
  std::vector<BvhJoint> joints_;
  std::vector<OpenBlock> blocks_;
  int first_tree_end_ = 0;
  bool is_complete_ = false;
};

BvhHierarchy HierarchyReader::read() {
  while (scanner_.peek().starts_with('#')) scanner_.rest_of_line();  // some exporters' remarks
  const auto first = scanner_.next();
  if (first.empty()) scanner_.fail(first, "the file is empty", kExportAgain);
  if (!is_word(first, "HIERARCHY"))
    scanner_.fail(first, "not a BVH file: expected HIERARCHY, got " + in_quotes(first),
                  "choose a .bvh file");
  while (!is_complete_) {
    const auto token = scanner_.next();
    if (token.empty()) fail_truncated(token);
    if (blocks_.empty()) {
      read_outside_block(token);
    } else if (token == "}") {
      close_block(token);
    } else if (blocks_.back().is_end_site) {
      read_end_site_item(token);
    } else {
      read_joint_item(token);
    }
  }
  return {std::move(joints_), first_tree_end_};
}

void HierarchyReader::fail_truncated(std::string_view token) {
  if (joints_.empty()) scanner_.fail(token, "there is no ROOT", kExportAgain);
  if (blocks_.empty()) scanner_.fail(token, "there is no MOTION section", kExportAgain);
  const auto& open = joint(blocks_.back().joint);
  scanner_.fail(token,
                "the file ends inside joint " + in_quotes(open.name) + " of line " +
                    std::to_string(open.location.line) + ": " + std::to_string(blocks_.size()) +
                    " '}' are missing",
                kExportAgain);
}

void HierarchyReader::read_outside_block(std::string_view token) {
  if (is_word(token, "ROOT")) {
    if (!joints_.empty())
      warn(scanner_.location(token), "a further ROOT; only the first one is read");
    open_joint(token);
  } else if (is_word(token, "MOTION")) {
    if (joints_.empty())
      scanner_.fail(token, "there is no ROOT before MOTION", "put the joints before it");
    is_complete_ = true;
  } else {
    scanner_.fail(token, "expected ROOT or MOTION, got " + in_quotes(token),
                  token == "}" ? "there is one '}' too many" : kCheckBraces);
  }
}

void HierarchyReader::read_joint_item(std::string_view token) {
  auto& current = joint(blocks_.back().joint);
  if (is_word(token, "OFFSET")) {
    if (current.offset)
      scanner_.fail(token, "a second OFFSET of joint " + in_quotes(current.name), kRemoveOne);
    current.offset = lengths_m(scanner_, "3 numbers after OFFSET", bvh_unit_m(options_));
  } else if (is_word(token, "CHANNELS")) {
    read_channels(token);
  } else if (is_word(token, "JOINT")) {
    open_joint(token);
  } else if (is_word(token, "End") || is_word(token, "EndSite")) {
    open_end_site();
  } else {
    scanner_.fail(token,
                  "expected OFFSET, CHANNELS, JOINT, End Site or '}' in joint " +
                      in_quotes(current.name) + ", got " + in_quotes(token),
                  kCheckBraces);
  }
}

void HierarchyReader::read_end_site_item(std::string_view token) {
  auto& block = blocks_.back();
  if (is_word(token, "OFFSET")) {
    if (block.has_offset) scanner_.fail(token, "a second OFFSET of an End Site", kRemoveOne);
    block.has_offset = true;
    const Vec3 offset = lengths_m(scanner_, "3 numbers after OFFSET", bvh_unit_m(options_));
    auto& end_site = joint(block.joint).end_site;
    if (!end_site) end_site = offset;
  } else if (is_word(token, "CHANNELS")) {
    if (read_channel_count() != 0)
      scanner_.fail(token, "an End Site cannot have channels", "remove the line");
  } else {
    scanner_.fail(token, "expected OFFSET or '}' in an End Site, got " + in_quotes(token),
                  kCheckBraces);
  }
}

void HierarchyReader::open_joint(std::string_view keyword) {
  if (static_cast<int>(joints_.size()) >= options_.max_joints)
    scanner_.fail(keyword, "there are more than " + std::to_string(options_.max_joints) + " joints",
                  "raise the limit max_joints if that is intended");
  BvhJoint opened;
  opened.name = read_name(keyword);
  opened.location = scanner_.location(keyword);
  if (!blocks_.empty()) {
    opened.parent = blocks_.back().joint;
    ++joint(opened.parent).num_children;
  }
  expect_opening_brace("joint " + in_quotes(opened.name));
  joints_.push_back(std::move(opened));
  push_block(keyword, {static_cast<int>(joints_.size()) - 1});
}

// "End Site" or "End Site AnyName"; the name is ignored.
void HierarchyReader::open_end_site() {
  const int parent = blocks_.back().joint;
  std::string_view token = scanner_.peek();
  while (!scanner_.at_line_end() && scanner_.peek() != "{") token = scanner_.next();
  ++joint(parent).num_children;
  expect_opening_brace("End Site");
  push_block(token, {parent, true});
}

void HierarchyReader::push_block(std::string_view keyword, OpenBlock block) {
  if (static_cast<int>(blocks_.size()) >= options_.max_depth + (block.is_end_site ? 1 : 0))
    scanner_.fail(keyword, "joints are nested deeper than " + std::to_string(options_.max_depth),
                  "raise the limit max_depth if that is intended");
  blocks_.push_back(block);
}

void HierarchyReader::close_block(std::string_view token) {
  const auto block = blocks_.back();
  blocks_.pop_back();
  auto& closed = joint(block.joint);
  if (block.is_end_site) {
    if (block.has_offset) return;
    warn(scanner_.location(token), "an End Site without OFFSET; zero is used");
    if (!closed.end_site) closed.end_site = Vec3::Zero();
    return;
  }
  if (!closed.offset)
    scanner_.fail(token, "joint " + in_quotes(closed.name) + " has no OFFSET",
                  "add a line OFFSET x y z");
  if (!closed.channels) {
    warn(closed.location, "joint " + in_quotes(closed.name) + " has no CHANNELS; it does not move");
    closed.channels.emplace();
  }
  if (blocks_.empty() && first_tree_end_ == 0) first_tree_end_ = static_cast<int>(joints_.size());
}

// Everything on the line before the brace; several words become one.
std::string HierarchyReader::read_name(std::string_view keyword) {
  if (scanner_.at_line_end() || scanner_.peek() == "{")
    scanner_.fail(scanner_.peek(), "the name after " + std::string(keyword) + " is missing",
                  "write it on the same line");
  const auto first_word = scanner_.peek();
  std::string name;
  int num_words = 0;
  while (!scanner_.at_line_end() && scanner_.peek() != "{") {
    const auto word = scanner_.next();
    if (word == "}") scanner_.fail(word, "expected a name and '{', got '}'", kCheckBraces);
    if (num_words++ > 0) name += '_';
    name += word;
  }
  name = checked_name(scanner_, first_word, name, warnings_);
  if (num_words > 1)
    warn(scanner_.location(keyword), "a name with spaces; read as " + in_quotes(name));
  return name;
}

void HierarchyReader::expect_opening_brace(std::string_view after) {
  const auto token = scanner_.next();
  if (token == "{") return;
  const std::string got = token.empty() ? "but the file ends" : "got " + in_quotes(token);
  scanner_.fail(token, "expected '{' after " + std::string(after) + ", " + got, kCheckBraces);
}

int HierarchyReader::read_channel_count() {
  const auto token = scanner_.peek();
  const double count = scanner_.number("the number of channels after CHANNELS");
  if (count < 0 || count > kMaxChannels || count != std::floor(count))
    scanner_.fail(token,
                  "CHANNELS says " + std::string(token) + ", it must be a whole number from 0 to " +
                      std::to_string(kMaxChannels),
                  kCountChannels);
  return static_cast<int>(count);
}

void HierarchyReader::read_channels(std::string_view keyword) {
  const int owner = blocks_.back().joint;
  if (joint(owner).channels)
    scanner_.fail(keyword, "a second CHANNELS of joint " + in_quotes(joint(owner).name),
                  kRemoveOne);
  const int declared = read_channel_count();
  std::vector<BvhChannel> channels;
  std::string_view token = scanner_.peek();
  const auto is_next_item = [&] {
    return token.empty() || token == "}" || is_word(token, "JOINT") || is_word(token, "End") ||
           is_word(token, "EndSite") || is_word(token, "OFFSET") || is_word(token, "MOTION");
  };
  while (find_channel(token) != nullptr ||
         (static_cast<int>(channels.size()) < declared && !is_next_item())) {
    const auto* channel = find_channel(token);
    if (channel == nullptr)
      scanner_.fail(token, "unknown channel " + in_quotes(token),
                    "use Xposition to Zposition and Xrotation to Zrotation");
    const auto is_same = [&](const BvhChannel& other) {
      return other.is_rotation == channel->is_rotation && other.axis == channel->axis;
    };
    if (std::ranges::any_of(channels, is_same))
      scanner_.fail(token, "channel " + in_quotes(token) + " is listed twice", kRemoveOne);
    channels.push_back(*channel);
    scanner_.next();
    token = scanner_.peek();
  }
  if (static_cast<int>(channels.size()) != declared)
    scanner_.fail(keyword,
                  "CHANNELS says " + std::to_string(declared) + ", but " +
                      std::to_string(channels.size()) + " channel names follow",
                  kCountChannels);
  joint(owner).channels = std::move(channels);
}

}  // namespace

BvhHierarchy read_bvh_hierarchy(TextScanner& scanner, const ReadOptions& options,
                                std::vector<ReadWarning>& warnings) {
  return HierarchyReader(scanner, options, warnings).read();
}

}  // namespace sparse_mocap
