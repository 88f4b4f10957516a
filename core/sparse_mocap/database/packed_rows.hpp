// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sparse_mocap/database/database_rows.hpp"

namespace sparse_mocap {

// The numbers of one clip as a database file keeps them: values times scale, in two bytes each.
// The scale is the smallest power of two that fits, so that packing what was unpacked gives the
// same again; at most half a scale is lost: 0.03 mm of positions within 2 m, 0.5 mm/s^2 of specific
// forces within 32 m/s^2.
struct PackedArray {
  Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;
  float scale = 1.0F;
};

// The largest magnitude that can be packed.
inline constexpr float kLargestPacked = 1e30F;

// Throws std::invalid_argument when a number is not finite, or larger.
PackedArray packed(const DatabaseRows::Rows& rows);
DatabaseRows::Rows unpacked(const PackedArray& array);

// What the sensors of one site read.
struct PackedSite {
  PackedArray specific_force_pivot, specific_force_end, angular_velocity, gravity_direction;
  PackedArray orientation{};  // as SiteRows; no rows where the clip's take does not tell it
};

// The rows of one clip, packed.
struct PackedRows {
  PackedArray angles, positions, extremities;
  DatabaseRows::Rows root_motion;
  Eigen::Matrix<std::uint8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> contacts;
  std::vector<PackedSite> sites;

  int num_frames() const { return static_cast<int>(angles.values.rows()); }
};

// Angles come out between -pi and pi.
PackedRows packed(const DatabaseRows& rows);
DatabaseRows unpacked(const PackedRows& rows);

}  // namespace sparse_mocap
