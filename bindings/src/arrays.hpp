// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace sparse_mocap::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Throws ValueError naming what was expected (-1: any length) and what came.
void require_shape(const Doubles& array, const std::vector<py::ssize_t>& expected,
                   const char* name);

// A new array of this shape.
py::array_t<double> new_array(const std::vector<py::ssize_t>& shape);

inline std::span<const double> span_of(const Doubles& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

// An array (T,) of numbers.
py::array_t<double> array_of(std::span<const double> numbers);

// Row-major T x C is column-major C x T.
inline Eigen::Map<const Eigen::MatrixXd> columns_of(const Doubles& rows) {
  return {rows.data(), rows.shape(1), rows.shape(0)};
}

// An array (T, C) of a matrix of C x T.
py::array_t<double> rows_of(const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace sparse_mocap::python
