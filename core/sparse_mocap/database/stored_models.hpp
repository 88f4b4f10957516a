// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/database/safetensors.hpp"

namespace sparse_mocap {

// How models lie in a motion database. Its metadata `models` lists them,
//   {"liu2011": {"version": 1, "metadata": {"subjects": "12"}}}
// and the tensors of each are called models/<method>/<name>.

inline constexpr char kModelsKey[] = "models";

// Whose models the metadata list, sorted. Throws std::invalid_argument when the list is damaged.
std::vector<std::string> stored_methods(const std::map<std::string, std::string>& metadata);

// The model of a method that is listed. Throws std::invalid_argument when it is not sound.
Model stored_model(const SafetensorsView& content, const std::string& method);

// Whether it is a tensor of a method's model.
bool is_of_model(const Tensor& tensor, const std::string& method);

// Adds a model; the new tensors view the model's. Throws std::invalid_argument as check_model.
void add_stored_model(SafetensorsView& content, const Model& model);

// Removes all that there is of a method's model.
void remove_stored_model(SafetensorsView& content, const std::string& method);

// The method's own metadata as JSON and back. Both throw std::invalid_argument.
std::string text_of_metadata(const std::map<std::string, std::string>& metadata);
std::map<std::string, std::string> metadata_from_text(const std::string& text);

// Of an array that lies somewhere else.
ModelTensor copied(const Tensor& tensor);
// The other way round; views the tensor.
Tensor viewed(const std::string& name, const ModelTensor& tensor);

}  // namespace sparse_mocap
