// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap::testing {

// The textbook matrices of the six Tait-Bryan orders, written out, so that no test multiplies
// rotations as the readers do.

// Angles whose sines and cosines are ratios of whole numbers: 3-4-5, 5-12-13, 8-15-17.
inline const std::string kAngles = "53.13010235415598 22.619864948040426 28.072486935852957";
inline constexpr double s1 = 0.8, c1 = 0.6;
inline constexpr double s2 = 5.0 / 13, c2 = 12.0 / 13;
inline constexpr double s3 = 8.0 / 17, c3 = 15.0 / 17;

struct Order {
  const char* name;
  std::array<double, 9> matrix;  // row by row
};

inline const std::array<Order, 6> kOrders{{
    {"XYZ",
     {c2 * c3, -c2* s3, s2,                               //
      c1* s3 + c3* s1* s2, c1* c3 - s1* s2* s3, -c2* s1,  //
      s1* s3 - c1* c3* s2, c3* s1 + c1* s2* s3, c1* c2}},
    {"XZY",
     {c2 * c3, -s2, c2* s3,                              //
      s1* s3 + c1* c3* s2, c1* c2, c1* s2* s3 - c3* s1,  //
      c3* s1* s2 - c1* s3, c2* s1, c1* c3 + s1* s2* s3}},
    {"YXZ",
     {c1 * c3 + s1 * s2 * s3, c3* s1* s2 - c1* s3, c2* s1,  //
      c2* s3, c2* c3, -s2,                                  //
      c1* s2* s3 - c3* s1, c1* c3* s2 + s1* s3, c1* c2}},
    {"YZX",
     {c1 * c2, s1* s3 - c1* c3* s2, c3* s1 + c1* s2* s3,  //
      s2, c2* c3, -c2* s3,                                //
      -c2* s1, c1* s3 + c3* s1* s2, c1* c3 - s1* s2* s3}},
    {"ZYX",
     {c1 * c2, c1* s2* s3 - c3* s1, s1* s3 + c1* c3* s2,  //
      c2* s1, c1* c3 + s1* s2* s3, c3* s1* s2 - c1* s3,   //
      -s2, c2* s3, c2* c3}},
    {"ZXY",
     {c1 * c3 - s1 * s2 * s3, -c2* s1, c1* s3 + c3* s1* s2,  //
      c3* s1 + c1* s2* s3, c1* c2, s1* s3 - c1* c3* s2,      //
      -c2* s3, s2, c2* c3}},
}};

inline Mat3 matrix_of(const Order& order) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(order.matrix.data());
}

}  // namespace sparse_mocap::testing
