// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sparse_mocap/database/rows_view.hpp"
#include "sparse_mocap/database/safetensors.hpp"

namespace sparse_mocap {

// An array that owns its elements, the last index running fastest.
struct ModelTensor {
  ElementType type = ElementType::f32;
  std::vector<std::size_t> shape;  // empty: a single value
  std::vector<std::byte> bytes;

  bool operator==(const ModelTensor&) const = default;
};

template <typename Scalar>
using VectorView = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;

// What a method has learned: named arrays, and texts that say how it came about.
struct Model {
  std::string method;                           // whose model it is, see method_names
  int version = 1;                              // of what that method keeps in its models
  std::map<std::string, std::string> metadata;  // the method's own
  std::map<std::string, ModelTensor> tensors;
  std::filesystem::path path;  // the file that it was read from, for messages; may be empty

  // Puts in a copy of a matrix, or of a vector as an array of one index. The scalars are float,
  // double, std::int32_t, std::int64_t or std::uint8_t.
  template <typename Derived>
  void set(const std::string& name, const Eigen::DenseBase<Derived>& values);

  // The array, which lives as long as the model's. Nothing is converted. Throws FormatError when
  // there is none, or it has another element type, another number of indices or another size than
  // asked for.
  template <typename Scalar>
  RowsView<Scalar> matrix(const std::string& name, std::optional<Eigen::Index> rows = {},
                          std::optional<Eigen::Index> columns = {}) const;
  template <typename Scalar>
  VectorView<Scalar> vector(const std::string& name, std::optional<Eigen::Index> size = {}) const;

  // The array of any shape where shape says nothing of an index. Throws as above.
  const ModelTensor& tensor(const std::string& name, ElementType type,
                            const std::vector<std::optional<Eigen::Index>>& shape) const;
};

// What every model keeps to: a method's name of a-z, 0-9 and _ that begins with a letter, a version
// from 1 on, tensors with a name and as many bytes as their shape says, floats that are finite,
// texts in UTF-8. Throws std::invalid_argument: "the tensor 'W' holds a value that is not a
// number".
void check_model(const Model& model);
bool is_method_name(const std::string& name);

// --- Implementation ------------------------------------------------------------------------------

template <typename Derived>
void Model::set(const std::string& name, const Eigen::DenseBase<Derived>& values) {
  using Scalar = typename Derived::Scalar;
  const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
  const auto bytes = std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(rows.size())));
  ModelTensor tensor{kElementTypeOf<Scalar>, {}, {bytes.begin(), bytes.end()}};
  if constexpr (Derived::IsVectorAtCompileTime)
    tensor.shape = {static_cast<std::size_t>(values.size())};
  else
    tensor.shape = {static_cast<std::size_t>(values.rows()),
                    static_cast<std::size_t>(values.cols())};
  tensors[name] = std::move(tensor);
}

template <typename Scalar>
RowsView<Scalar> Model::matrix(const std::string& name, std::optional<Eigen::Index> rows,
                               std::optional<Eigen::Index> columns) const {
  const ModelTensor& found = tensor(name, kElementTypeOf<Scalar>, {rows, columns});
  return {reinterpret_cast<const Scalar*>(found.bytes.data()),
          static_cast<Eigen::Index>(found.shape[0]), static_cast<Eigen::Index>(found.shape[1])};
}

template <typename Scalar>
VectorView<Scalar> Model::vector(const std::string& name, std::optional<Eigen::Index> size) const {
  const ModelTensor& found = tensor(name, kElementTypeOf<Scalar>, {size});
  return {reinterpret_cast<const Scalar*>(found.bytes.data()),
          static_cast<Eigen::Index>(found.shape[0])};
}

}  // namespace sparse_mocap
