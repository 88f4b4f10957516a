// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/rows_view.hpp"

namespace sparse_mocap {

// An array of a file as rows. Throws FormatError when it is missing, has no checksum, or has
// another element type or another number of columns.
template <typename Scalar>
RowsView<Scalar> mapped_rows(const Container& container, const std::string& name,
                             std::size_t columns) {
  const Tensor& tensor = container.tensor(name);
  const auto refuse = [&](const std::string& what) {
    container.refuse("the array '" + name + "' " + what);
  };
  if (!container.has_checksum(name)) refuse("has no checksum");
  if (tensor.type != kElementTypeOf<Scalar> || tensor.shape.size() != 2 ||
      tensor.shape[1] != columns)
    refuse("has not " + std::to_string(columns) + " columns");
  if (reinterpret_cast<std::uintptr_t>(tensor.bytes.data()) % alignof(Scalar) != 0)
    refuse("is not aligned");
  if (tensor.shape[0] > 2'000'000'000 / columns) refuse("has too many rows");
  return {reinterpret_cast<const Scalar*>(tensor.bytes.data()),
          static_cast<Eigen::Index>(tensor.shape[0]), static_cast<Eigen::Index>(columns)};
}

}  // namespace sparse_mocap
