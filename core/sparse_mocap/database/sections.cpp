// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/sections.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/strict_json.hpp"
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/database/model_file.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

constexpr char kDamagedList[] = "the list of its sections is damaged";
constexpr char kPrefix[] = "sections/";

std::string prefix_of(const std::string& section) { return kPrefix + section + "/"; }

json section_list(const std::map<std::string, std::string>& metadata) {
  const auto at = metadata.find(kSectionsKey);
  if (at == metadata.end()) return json::object();
  json list;
  try {
    list = parse_json_strictly(at->second);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(kDamagedList);
  }
  if (!list.is_object()) throw std::invalid_argument(kDamagedList);
  for (const auto& [name, entry] : list.items())
    if (!is_method_name(name) || !entry.is_object()) throw std::invalid_argument(kDamagedList);
  return list;
}

void put_list(SafetensorsView& further, const json& list) {
  if (list.empty()) {
    further.metadata.erase(kSectionsKey);
    return;
  }
  try {
    further.metadata[kSectionsKey] = list.dump();
  } catch (const json::type_error&) {
    throw std::invalid_argument("a text of a section is not UTF-8");
  }
}

}  // namespace

const Tensor& Section::tensor(const std::string& name, ElementType type,
                              std::size_t num_indices) const {
  const auto at = std::find_if(tensors.begin(), tensors.end(),
                               [&](const Tensor& tensor) { return tensor.name == name; });
  if (at == tensors.end() || at->type != type || at->shape.size() != num_indices)
    throw std::invalid_argument("the section has no tensor '" + name + "' of type " +
                                name_of(type) + " and " + std::to_string(num_indices) + " indices");
  return *at;
}

std::map<std::string, Section> sections_of(const SafetensorsView& further) {
  const json list = section_list(further.metadata);
  std::map<std::string, Section> sections;
  try {
    for (const auto& [name, entry] : list.items())
      sections[name] = {entry.at("version").get<int>(),
                        entry.at("rows").get<std::string>(),
                        entry.at("metadata").get<std::map<std::string, std::string>>(),
                        {}};
  } catch (const json::exception&) {
    throw std::invalid_argument(kDamagedList);
  }
  for (auto& [name, section] : sections) {
    const std::string prefix = prefix_of(name);
    for (const auto& tensor : further.tensors) {
      if (!tensor.name.starts_with(prefix)) continue;
      section.tensors.push_back(tensor);
      section.tensors.back().name.erase(0, prefix.size());
    }
  }
  return sections;
}

bool is_of_section(const Tensor& tensor) { return tensor.name.starts_with(kPrefix); }

void put_section(SafetensorsView& further, const std::string& name, const Section& section) {
  if (!is_method_name(name))
    throw std::invalid_argument("a section's name must be of a-z, 0-9 and _, not '" + name + "'");
  remove_section(further, name);
  json list = section_list(further.metadata);
  list[name] = {
      {"version", section.version}, {"rows", section.rows}, {"metadata", section.metadata}};
  put_list(further, list);
  for (Tensor tensor : section.tensors) {
    tensor.name.insert(0, prefix_of(name));
    further.tensors.push_back(std::move(tensor));
  }
}

void remove_section(SafetensorsView& further, const std::string& name) {
  json list = section_list(further.metadata);
  list.erase(name);
  put_list(further, list);
  std::erase_if(further.tensors, [prefix = prefix_of(name)](const Tensor& tensor) {
    return tensor.name.starts_with(prefix);
  });
}

void remove_stale_sections(SafetensorsView& further, const std::string& rows_hash) {
  for (const auto& [name, section] : sections_of(further))
    if (!section.rows.empty() && section.rows != rows_hash) remove_section(further, name);
}

void store_section(const std::filesystem::path& database, const std::string& name,
                   const Section& section) {
  change_database(database, [&](const MotionDatabase&, SafetensorsView& content) {
    put_section(content, name, section);
  });
}

}  // namespace sparse_mocap
