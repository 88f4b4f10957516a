// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

#include <algorithm>
#include <string>

namespace sparse_mocap::python {
namespace {

std::string shape_text(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ", ") + (shape[i] < 0 ? std::string("any") : std::to_string(shape[i]));
  return text + ")";
}

}  // namespace

void require_shape(const Doubles& array, const std::vector<py::ssize_t>& expected,
                   const char* name) {
  const std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
  bool is_right = shape.size() == expected.size();
  for (std::size_t i = 0; is_right && i < shape.size(); ++i)
    is_right = expected[i] < 0 || shape[i] == expected[i];
  if (!is_right)
    throw py::value_error(std::string(name) + " must have shape " + shape_text(expected) +
                          ", got " + shape_text(shape));
}

py::array_t<double> new_array(const std::vector<py::ssize_t>& shape) {
  return py::array_t<double>(shape);
}

py::array_t<double> array_of(std::span<const double> numbers) {
  auto out = new_array({static_cast<py::ssize_t>(numbers.size())});
  std::copy(numbers.begin(), numbers.end(), out.mutable_data());
  return out;
}

py::array_t<double> rows_of(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  auto rows = new_array({columns.cols(), columns.rows()});
  Eigen::Map<Eigen::MatrixXd>(rows.mutable_data(), columns.rows(), columns.cols()) = columns;
  return rows;
}

}  // namespace sparse_mocap::python
