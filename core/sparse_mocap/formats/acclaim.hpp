// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sparse_mocap/formats/motion_file.hpp"

namespace sparse_mocap {

// What one number of an .amc moves.
enum class AcclaimChannel { rx, ry, rz, tx, ty, tz, length };

// An Acclaim skeleton file (.asf) read: the joints in metres, and what reading an .amc needs.
//
// The root's preset orientation C offsets the whole capture: the root's world rotation is C times
// that of the .amc. It is built into the skeleton (bones, offsets and axes are turned by C), so
// that the angles of the .amc are the angles of the joints.
struct AcclaimSkeleton {
  std::filesystem::path path;
  Skeleton skeleton;
  std::vector<ReadWarning> warnings;
  // Per joint, in the order of the file's `dof` (or the root's `order`): which value it is.
  std::vector<std::vector<AcclaimChannel>> channels;
  double metres_per_unit = 0.0254;
  double radians_per_angle = kRadiansPerDegree;
  Vec3 root_position = Vec3::Zero();  // m, `position` of :root; is added to the .amc's translation
};

// Throws FormatError with line and column.
AcclaimSkeleton read_asf(const std::filesystem::path& path, const ReadOptions& options = {});
// The same on text that is (or will be) such a file; path is for messages.
AcclaimSkeleton asf_from_text(std::string text, const std::filesystem::path& path,
                              const ReadOptions& options = {});

// The skeleton that belongs to an .amc: in its folder the .asf whose name is the longest start of
// the .amc's name that ends before a '_' (HDM_bd.asf for HDM_bd_squat_001_120.amc, 02.asf for
// 02_01.amc), or the only .asf there. Throws FormatError naming the .amc, the folder and what was
// looked for.
std::filesystem::path find_asf(const std::filesystem::path& amc_path);

// Translations of bones become offset tracks; the `l` channel (stretch) is read and ignored, with a
// warning where it is not zero. Throws FormatError with line and column.
MotionFile read_amc(const std::filesystem::path& amc_path, const AcclaimSkeleton& skeleton,
                    const ReadOptions& options = {});
MotionFile amc_from_text(std::string text, const std::filesystem::path& amc_path,
                         const AcclaimSkeleton& skeleton, const ReadOptions& options = {});

}  // namespace sparse_mocap
