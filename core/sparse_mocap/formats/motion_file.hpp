// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// Limits of the readers, and properties that the files do not state.
struct ReadOptions {
  std::size_t max_bytes = std::size_t{2} << 30;
  int max_joints = 1024;
  int max_depth = 256;
  int max_frames = 3'000'000;
  std::size_t max_rotations = std::size_t{1} << 27;  // frames * joints, which limits memory
  double amc_rate_hz = 120.0;                        // AMC files do not state their rate
  double bvh_unit_m = 0.01;      // BVH files do not state their unit; the convention is cm
  Axis bvh_up = Axis::y;         // the file's up axis; the motion read always has y up
  bool allow_no_frames = false;  // a skeleton without motion is accepted

  // Throws ConfigError naming the option, its value and its range.
  void validate() const;
};

// Something suspicious that a reader accepted: the first of its kind in the file.
struct ReadWarning {
  FileLocation location;
  std::string text;
  int count = 1;  // how many of its kind the file holds

  // One line: "walk.bvh:5:3: a name with spaces; read as "Left_Arm" (and 3 more of this kind)".
  std::string message() const;
};

struct MotionFile {
  Motion motion;
  std::vector<ReadWarning> warnings;
};

// Whether the name ends in .bvh or .amc (any case).
bool is_motion_file(const std::filesystem::path& path);

// Reads .bvh, or .amc with the .asf found beside it (see find_asf). Throws FormatError.
MotionFile read_motion_file(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace sparse_mocap
