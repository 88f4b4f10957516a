// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

// The turn about the vertical that brings modelled rotations nearest to measured ones, one each;
// measured ones that are not finite take no part.
double common_yaw_rad(std::span<const Mat3> measured, std::span<const Mat3> modelled);

}  // namespace sparse_mocap
