// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

struct MotionFile;
struct ReadOptions;
using FurtherReader =
    std::function<MotionFile(const std::filesystem::path& path, const ReadOptions& options)>;

// Limits of the readers, and properties that the files do not state.
struct ReadOptions {
  std::size_t max_bytes = std::size_t{2} << 30;
  int max_joints = 1024;
  int max_depth = 256;
  int max_frames = 3'000'000;
  std::size_t max_rotations = std::size_t{1} << 27;  // frames * joints, which limits memory
  double amc_rate_hz = 120.0;                        // AMC files do not state their rate
  // Metres of one of the file's units; none: what an .asf says, cm for .bvh, which does not.
  std::optional<double> unit_m = {};
  Axis up = Axis::y;               // the file's up axis; the motion read always has y up
  std::filesystem::path asf = {};  // the skeleton of an .amc; empty: the one found beside it
  bool refuse_other_asf = false;  // refuse the only .asf of a folder if its name is another actor's
  bool allow_no_frames = false;   // a skeleton without motion is accepted
  // What the file's own rate is, whatever it says; for those that are known to be wrong.
  std::optional<double> rate_hz = {};
  // Readers of formats that are not read here, by ending (".npz", lower case). They may be called
  // by several threads at once and throw FormatError.
  std::map<std::string, FurtherReader> further_readers = {};

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

// Whether the name ends in .bvh or .amc, or what a further reader reads (any case).
bool is_motion_file(const std::filesystem::path& path, const ReadOptions& options = {});

// Reads .bvh, or .amc with its .asf (see find_asf), or where frames are not needed an .asf alone.
// Throws FormatError.
MotionFile read_motion_file(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace sparse_mocap
