// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"
#include "sparse_mocap/base/quaternions.hpp"

namespace sparse_mocap::python {
namespace {

Quat quaternion_at(const Doubles& rotations, py::ssize_t t) {
  return quaternion_of(Eigen::Map<const Eigen::Vector4d>(rotations.data(t, 0)));
}

void put(const Quat& rotation, py::array_t<double>& out, py::ssize_t t) {
  Eigen::Map<Eigen::Vector4d>(out.mutable_data(t, 0)) = wxyz_of(rotation);
}

py::array_t<double> product(const Doubles& left, const Doubles& right) {
  require_shape(left, {-1, 4}, "left");
  require_shape(right, {left.shape(0), 4}, "right");
  auto out = new_array({left.shape(0), 4});
  for (py::ssize_t t = 0; t < left.shape(0); ++t)
    put(quaternion_at(left, t) * quaternion_at(right, t), out, t);
  return out;
}

py::array_t<double> rotated(const Doubles& rotations, const Doubles& vectors) {
  require_shape(rotations, {-1, 4}, "rotations");
  require_shape(vectors, {rotations.shape(0), 3}, "vectors");
  auto out = new_array({rotations.shape(0), 3});
  for (py::ssize_t t = 0; t < rotations.shape(0); ++t)
    Eigen::Map<Vec3>(out.mutable_data(t, 0)) =
        quaternion_at(rotations, t) * Vec3(vectors.data(t, 0));
  return out;
}

py::array_t<double> from_matrices(const Doubles& matrices) {
  require_shape(matrices, {-1, 3, 3}, "matrices");
  auto out = new_array({matrices.shape(0), 4});
  for (py::ssize_t t = 0; t < matrices.shape(0); ++t) {
    const Mat3 R = Eigen::Map<const Mat3>(matrices.data(t, 0, 0)).transpose();
    put(Quat(R).normalized(), out, t);
  }
  return out;
}

}  // namespace

void bind_rotations(py::module_& m) {
  const Eigen::Vector4d R_world_zup = wxyz_of(kR_world_zup);
  m.attr("R_WORLD_ZUP") =
      py::make_tuple(R_world_zup[0], R_world_zup[1], R_world_zup[2], R_world_zup[3]);
  m.def("rotation_product", &product, py::arg("left"), py::arg("right"),
        "Returns left times right, (T, 4) each, w x y z: the rotation by right and then by left.");
  m.def("rotated", &rotated, py::arg("rotations"), py::arg("vectors"),
        "Returns vectors (T, 3), each turned by its rotation (T, 4), w x y z.");
  m.def("rotations_from_matrices", &from_matrices, py::arg("matrices"),
        "Returns the unit quaternions (T, 4), w x y z, of rotation matrices (T, 3, 3).");
}

}  // namespace sparse_mocap::python
