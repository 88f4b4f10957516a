// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/reader_support.hpp"

namespace sparse_mocap {

// The sections of an .asf as in the file: units of the file, names unresolved, since the
// sections may come in any order.

struct AsfBone {
  std::string name;
  std::string_view token;  // where the bone is defined
  Vec3 direction = Vec3::Zero();
  double length = 0.0;
  Vec3 axis_angles = Vec3::Zero();                            // about x, y and z
  std::array<Axis, 3> axis_order{Axis::x, Axis::y, Axis::z};  // the first turns first
  std::vector<AcclaimChannel> channels;
  std::string_view limits;  // the keyword; empty where there is none
  std::size_t num_limits = 0;
};

struct AsfRoot {
  std::vector<AcclaimChannel> channels;
  Vec3 position = Vec3::Zero();
  std::string_view position_key;  // where it is given; empty where it is not
  Vec3 orientation_angles = Vec3::Zero();
  std::array<Axis, 3> axis_order{Axis::x, Axis::y, Axis::z};
};

// One line of :hierarchy.
struct AsfFamily {
  std::string_view parent;
  std::vector<std::string_view> children;
};

struct AsfSections {
  double length_unit = 1.0;  // a value of the file is value / length_unit inches
  bool is_in_degrees = true;
  AsfRoot root;
  std::vector<AsfBone> bones;
  std::vector<AsfFamily> families;
};

// How Acclaim's two formats are cut into tokens.
inline constexpr TextScanner::Syntax kAcclaimSyntax{.blanks = ",()", .comment = '#'};

// Throws FormatError. The views point into the scanner's text.
AsfSections read_asf_sections(TextScanner& scanner, const ReadOptions& options,
                              std::vector<ReadWarning>& warnings);

}  // namespace sparse_mocap
