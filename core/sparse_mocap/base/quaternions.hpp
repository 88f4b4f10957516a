// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

// Rotations in files, streams and arrays are four numbers, w x y z.
inline Quat quaternion_of(const Eigen::Vector4d& wxyz) {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

inline Eigen::Vector4d wxyz_of(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

// Of a world with z up in this project's (y up), where which way is north does not matter: axes
// are exchanged, so that what was x is then z, y is x, z is y.
inline const Quat kR_world_zup = Quat(0.5, -0.5, -0.5, -0.5);

}  // namespace sparse_mocap
