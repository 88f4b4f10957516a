// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace sparse_mocap::streams::text_line {

// What a column of a line may hold.
enum class Column {
  time,
  sensor,
  counter,
  ax,
  ay,
  az,
  gx,
  gy,
  gz,
  mx,
  my,
  mz,
  qw,
  qx,
  qy,
  qz,
  skip
};

inline constexpr std::size_t kNumColumns = static_cast<std::size_t>(Column::skip) + 1;

inline constexpr std::array<std::string_view, kNumColumns> kColumnNames{
    "time", "sensor", "counter", "ax", "ay", "az", "gx", "gy",  "gz",
    "mx",   "my",     "mz",      "qw", "qx", "qy", "qz", "skip"};

// The column of this name; nothing for another name.
std::optional<Column> column_named(std::string_view name);

// The same for the names that sketches and programs print in header lines: AccX, gyro_y (deg/s),
// Time_ms, Quat W, ID.
std::optional<Column> header_column(std::string_view name);

// The seconds of a unit in the name of a time column, as in Time_ms or "t (us)"; else the default.
double header_tick_s(std::string_view name, double default_s);

}  // namespace sparse_mocap::streams::text_line
