// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {
namespace {

constexpr std::size_t kLongestName = 255;
constexpr int kHighestVersion = 1'000'000;

std::string shape_text(const std::vector<std::optional<Eigen::Index>>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + (shape[i] ? std::to_string(*shape[i]) : std::string("any"));
  return text + ")";
}

std::vector<std::optional<Eigen::Index>> known(const std::vector<std::size_t>& shape) {
  std::vector<std::optional<Eigen::Index>> sizes;
  for (const std::size_t n : shape) sizes.emplace_back(static_cast<Eigen::Index>(n));
  return sizes;
}

bool has_shape(const ModelTensor& tensor, const std::vector<std::optional<Eigen::Index>>& shape) {
  return std::equal(tensor.shape.begin(), tensor.shape.end(), shape.begin(), shape.end(),
                    [](std::size_t n, const std::optional<Eigen::Index>& wanted) {
                      return !wanted || *wanted == static_cast<Eigen::Index>(n);
                    });
}

std::string names_of(const std::map<std::string, ModelTensor>& tensors) {
  std::string names;
  for (const auto& [name, tensor] : tensors) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

// Whether bytes hold as many elements as the shape says.
bool has_size_of_shape(const ModelTensor& tensor) {
  std::size_t total = size_of(tensor.type);
  for (const std::size_t n : tensor.shape) {
    if (n > static_cast<std::size_t>(std::numeric_limits<Eigen::Index>::max())) return false;
    if (n != 0 && total > std::numeric_limits<std::size_t>::max() / n) return false;
    total *= n;
  }
  return total == tensor.bytes.size();
}

template <typename Scalar>
bool all_finite(const std::vector<std::byte>& bytes) {
  for (std::size_t at = 0; at + sizeof(Scalar) <= bytes.size(); at += sizeof(Scalar)) {
    Scalar value;
    std::memcpy(&value, &bytes[at], sizeof(Scalar));
    if (!std::isfinite(value)) return false;
  }
  return true;
}

void check_tensor(const std::string& name, const ModelTensor& tensor) {
  if (name.empty() || name.size() > kLongestName || name == "__metadata__")
    throw std::invalid_argument("'" + name + "' cannot be a tensor's name");
  if (!has_size_of_shape(tensor))
    throw std::invalid_argument("the tensor '" + name + "' does not have the size of its shape");
  const bool is_finite = tensor.type == ElementType::f32   ? all_finite<float>(tensor.bytes)
                         : tensor.type == ElementType::f64 ? all_finite<double>(tensor.bytes)
                                                           : true;
  if (!is_finite)
    throw std::invalid_argument("the tensor '" + name + "' holds a value that is not a number");
}

}  // namespace

const ModelTensor& Model::tensor(const std::string& name, ElementType type,
                                 const std::vector<std::optional<Eigen::Index>>& shape) const {
  const auto refuse = [&](const std::string& problem) {
    throw FormatError({path}, problem, "train it again with this version");
  };
  const auto at = tensors.find(name);
  if (at == tensors.end())
    refuse("the model of '" + method + "' has no tensor '" + name + "', it has " +
           names_of(tensors));
  const ModelTensor& found = at->second;
  if (found.type != type)
    refuse("the tensor '" + name + "' of the model of '" + method + "' has elements " +
           name_of(found.type) + ", not " + name_of(type));
  if (!has_shape(found, shape))
    refuse("the tensor '" + name + "' of the model of '" + method + "' has shape " +
           shape_text(known(found.shape)) + ", not " + shape_text(shape));
  return found;
}

bool is_method_name(const std::string& name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= kLongestName && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

void check_model(const Model& model) {
  if (!is_method_name(model.method))
    throw std::invalid_argument("'" + model.method + "' cannot be a method's name");
  if (model.version < 1 || model.version > kHighestVersion)
    throw std::invalid_argument("a model's version cannot be " + std::to_string(model.version));
  for (const auto& [name, tensor] : model.tensors) check_tensor(name, tensor);
}

}  // namespace sparse_mocap
