// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/mapping_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/base/strict_json.hpp"

namespace sparse_mocap {
namespace {

constexpr const char* kFormat = "sparse_mocap_mapping";
constexpr int kFormatVersion = 1;
constexpr std::size_t kMaxBytes = 1'000'000;

nlohmann::json parse(const std::filesystem::path& path) {
  try {
    return parse_json_strictly(read_file(path, kMaxBytes));
  } catch (const std::invalid_argument& error) {
    throw FormatError({path}, std::string("the mapping ") + error.what(),
                      "write one with inspect --save-mapping and edit that");
  }
}

// Mappings written before versions were stated are of version 1.
void check_version(const nlohmann::json& file, const std::filesystem::path& path) {
  const nlohmann::json version = file.value("format_version", nlohmann::json(kFormatVersion));
  if (version == kFormatVersion) return;
  throw FormatError({path},
                    "is a mapping of format version " + version.dump() +
                        ", and this program reads version " + std::to_string(kFormatVersion),
                    "update Sparse Mocap, or write it again with inspect --save-mapping");
}

}  // namespace

JointNames read_mapping(const std::filesystem::path& path) {
  const nlohmann::json file = parse(path);
  if (!file.is_object() || file.value("format", nlohmann::json()) != kFormat)
    throw FormatError({path}, "is not a mapping of joints",
                      std::string("it must be an object with \"format\": \"") + kFormat + "\"");
  check_version(file, path);
  for (const auto& [key, value] : file.items())
    if (key != "format" && key != "format_version" && key != "joints")
      throw FormatError({path}, "unknown key '" + key + "'",
                        "known: format, format_version, joints");
  JointNames joints;
  try {
    joints = file.at("joints").get<JointNames>();
  } catch (const nlohmann::json::exception&) {
    throw FormatError({path}, "'joints' must be an object from standard joints to the file's",
                      R"(as in {"lfemur": "LeftUpLeg"})");
  }
  for (const auto& [standard, name] : joints)
    if (!is_mapped_name(standard))
      throw FormatError({path}, "'" + standard + "' is not a standard joint",
                        "the nearest is '" + nearest_standard_joint(standard) + "'");
  return joints;
}

void write_mapping(const std::filesystem::path& path, const JointNames& joints) {
  const nlohmann::ordered_json file{
      {"format", kFormat}, {"format_version", kFormatVersion}, {"joints", joints}};
  write_file_atomically(path, file.dump(2) + "\n");
}

std::filesystem::path remembered_mapping_path(const std::filesystem::path& folder,
                                              const Skeleton& rig) {
  std::string tree;
  for (const auto& joint : rig.joints())
    tree += joint.name + '\n' + std::to_string(joint.parent) + '\n';
  return folder / (checksum(std::as_bytes(std::span(tree))) + ".json");
}

JointNames remembered_mapping(const std::filesystem::path& folder, const Skeleton& rig) {
  const auto path = remembered_mapping_path(folder, rig);
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? read_mapping(path) : JointNames();
}

std::map<std::string, JointNames> remembered_mappings(const std::filesystem::path& folder) {
  std::map<std::string, JointNames> mappings;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".json")
      mappings.emplace(entry.path().stem().string(), read_mapping(entry.path()));
  return mappings;
}

SkeletonMapping map_as_chosen(const Motion& source, const MappingChoice& choice) {
  const auto has = [&](const auto& pair) { return source.skeleton.find(pair.second) >= 0; };
  JointNames by_hand;
  if (std::all_of(choice.by_hand.begin(), choice.by_hand.end(), has)) by_hand = choice.by_hand;
  if (by_hand.empty() && !choice.remembered.empty())
    by_hand = remembered_mapping(choice.remembered, source.skeleton);
  const auto rig = choice.by_rig.find(remembered_mapping_path({}, source.skeleton).stem().string());
  if (by_hand.empty() && rig != choice.by_rig.end()) by_hand = rig->second;
  SkeletonMapping mapping = map_skeleton(source, by_hand);
  if (!by_hand.empty()) mapping.warnings.emplace_back("the body was mapped by hand");
  return mapping;
}

}  // namespace sparse_mocap
