// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/formats/reader_support.hpp"

namespace sparse_mocap {

struct BvhChannel {
  bool is_rotation = false;
  Axis axis = Axis::x;
};

struct BvhJoint {
  std::string name;
  int parent = -1;  // -1: a root
  FileLocation location;
  std::optional<Vec3> offset;                       // m
  std::optional<Vec3> end_site;                     // m; of the first End Site
  int num_children = 0;                             // joints and End Sites
  std::optional<std::vector<BvhChannel>> channels;  // in the order of the file
};

// The HIERARCHY of a BVH file; joints in the order of the file, which is that of the columns.
struct BvhHierarchy {
  std::vector<BvhJoint> joints;
  // Joints [0, first_tree_end) hang from the first ROOT; what follows belongs to further ROOTs.
  int first_tree_end = 0;
};

// BVH files do not state their unit; the convention is cm.
inline double bvh_unit_m(const ReadOptions& options) { return options.unit_m.value_or(0.01); }

// Reads up to and with the word MOTION. Throws FormatError.
BvhHierarchy read_bvh_hierarchy(TextScanner& scanner, const ReadOptions& options,
                                std::vector<ReadWarning>& warnings);

}  // namespace sparse_mocap
