// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/packed_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {
namespace {

using Rows = DatabaseRows::Rows;

constexpr float kLargest = std::numeric_limits<std::int16_t>::max();
constexpr int kSmallestExponent = -20;  // a scale of a millionth; what is smaller does not matter

// The smallest power of two times which the largest whole number is no less than the magnitude.
float scale_for(float magnitude) {
  int exponent = kSmallestExponent;
  std::frexp(magnitude / kLargest, &exponent);
  exponent = std::max(exponent, kSmallestExponent);
  // frexp's power is greater than the quotient; one less may do.
  if (exponent > kSmallestExponent && magnitude <= kLargest * std::ldexp(1.0F, exponent - 1))
    --exponent;
  return std::ldexp(1.0F, exponent);
}

Rows site_columns(const Rows& rows, std::size_t site) {
  return rows.middleCols(static_cast<Eigen::Index>(3 * site), 3);
}

}  // namespace

PackedArray packed(const Rows& rows) {
  if (!rows.allFinite()) throw std::invalid_argument("a value is not a number");
  const float magnitude = rows.size() > 0 ? rows.cwiseAbs().maxCoeff() : 0.0F;
  if (magnitude > kLargestPacked) throw std::invalid_argument("a value is impossible");
  PackedArray out;
  out.scale = scale_for(magnitude);
  out.values = (rows / out.scale).array().round().matrix().cast<std::int16_t>();
  return out;
}

Rows unpacked(const PackedArray& array) { return array.values.cast<float>() * array.scale; }

PackedRows packed(const DatabaseRows& rows) {
  constexpr float kFullTurn = static_cast<float>(2.0 * kPi);
  PackedRows out;
  out.angles = packed(
      Rows(rows.angles.unaryExpr([](float angle) { return std::remainder(angle, kFullTurn); })));
  out.positions = packed(rows.positions);
  out.extremities = packed(rows.extremities);
  out.root_motion = rows.root_motion;
  out.contacts = (rows.contacts.array() > 0.5F).cast<std::uint8_t>();
  const auto num_sites = static_cast<std::size_t>(rows.specific_force_pivot.cols() / 3);
  for (std::size_t s = 0; s < num_sites; ++s)
    out.sites.push_back({packed(site_columns(rows.specific_force_pivot, s)),
                         packed(site_columns(rows.specific_force_end, s)),
                         packed(site_columns(rows.angular_velocity, s)),
                         packed(site_columns(rows.gravity_direction, s))});
  return out;
}

DatabaseRows unpacked(const PackedRows& rows) {
  DatabaseRows out;
  out.angles = unpacked(rows.angles);
  out.positions = unpacked(rows.positions);
  out.extremities = unpacked(rows.extremities);
  out.root_motion = rows.root_motion;
  out.contacts = rows.contacts.cast<float>();
  for (const auto& [target, member] :
       {std::pair{&out.specific_force_pivot, &PackedSite::specific_force_pivot},
        {&out.specific_force_end, &PackedSite::specific_force_end},
        {&out.angular_velocity, &PackedSite::angular_velocity},
        {&out.gravity_direction, &PackedSite::gravity_direction}}) {
    target->resize(rows.num_frames(), static_cast<Eigen::Index>(3 * rows.sites.size()));
    for (std::size_t s = 0; s < rows.sites.size(); ++s)
      target->middleCols(static_cast<Eigen::Index>(3 * s), 3) = unpacked(rows.sites[s].*member);
  }
  return out;
}

}  // namespace sparse_mocap
