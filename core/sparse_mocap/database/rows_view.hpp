// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap {

// Rows as they lie in a file: one after another.
template <typename Scalar>
using RowsView =
    Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
using FloatRows = RowsView<float>;

}  // namespace sparse_mocap
