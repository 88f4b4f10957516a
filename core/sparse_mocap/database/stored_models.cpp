// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/stored_models.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/strict_json.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

constexpr char kDamagedList[] = "the list of its models is damaged";

std::string prefix_of(const std::string& method) { return "models/" + method + "/"; }

json model_list(const std::map<std::string, std::string>& metadata) {
  const auto at = metadata.find(kModelsKey);
  if (at == metadata.end()) return json::object();
  json list;
  try {
    list = parse_json_strictly(at->second);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(kDamagedList);
  }
  if (!list.is_object()) throw std::invalid_argument(kDamagedList);
  for (const auto& [method, entry] : list.items())
    if (!is_method_name(method) || !entry.is_object()) throw std::invalid_argument(kDamagedList);
  return list;
}

std::string dumped(const json& value) {
  try {
    return value.dump();
  } catch (const json::type_error&) {
    throw std::invalid_argument("a text of the model's metadata is not UTF-8");
  }
}

}  // namespace

std::vector<std::string> stored_methods(const std::map<std::string, std::string>& metadata) {
  const json list = model_list(metadata);
  std::vector<std::string> methods;
  for (const auto& [method, entry] : list.items()) methods.push_back(method);
  return methods;
}

Model stored_model(const SafetensorsView& content, const std::string& method) {
  Model model;
  model.method = method;
  const json list = model_list(content.metadata);
  try {
    model.version = list.at(method).at("version").get<int>();
    model.metadata = list.at(method).at("metadata").get<std::map<std::string, std::string>>();
  } catch (const json::exception&) {
    throw std::invalid_argument(kDamagedList);
  }
  const std::size_t prefix = prefix_of(method).size();
  for (const auto& tensor : content.tensors)
    if (is_of_model(tensor, method))
      model.tensors.emplace(tensor.name.substr(prefix), copied(tensor));
  check_model(model);
  return model;
}

bool is_of_model(const Tensor& tensor, const std::string& method) {
  return tensor.name.starts_with(prefix_of(method));
}

void add_stored_model(SafetensorsView& content, const Model& model) {
  check_model(model);
  json list = model_list(content.metadata);
  list[model.method] = {{"version", model.version}, {"metadata", model.metadata}};
  content.metadata[kModelsKey] = dumped(list);
  for (const auto& [name, tensor] : model.tensors)
    content.tensors.push_back(viewed(prefix_of(model.method) + name, tensor));
}

void remove_stored_model(SafetensorsView& content, const std::string& method) {
  json list = model_list(content.metadata);
  list.erase(method);
  if (list.empty())
    content.metadata.erase(kModelsKey);
  else
    content.metadata[kModelsKey] = dumped(list);
  std::erase_if(content.tensors, [&](const Tensor& tensor) { return is_of_model(tensor, method); });
}

std::string text_of_metadata(const std::map<std::string, std::string>& metadata) {
  return dumped(json(metadata));
}

std::map<std::string, std::string> metadata_from_text(const std::string& text) {
  try {
    return parse_json_strictly(text).get<std::map<std::string, std::string>>();
  } catch (const json::exception&) {
    throw std::invalid_argument("the model's metadata are no texts");
  }
}

ModelTensor copied(const Tensor& tensor) {
  return {tensor.type, tensor.shape, {tensor.bytes.begin(), tensor.bytes.end()}};
}

Tensor viewed(const std::string& name, const ModelTensor& tensor) {
  return {name, tensor.type, tensor.shape, tensor.bytes};
}

}  // namespace sparse_mocap
