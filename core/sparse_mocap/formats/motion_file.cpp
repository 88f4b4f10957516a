// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/motion_file.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "sparse_mocap/base/text_scanner.hpp"
#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "sparse_mocap/formats/reader_support.hpp"

namespace sparse_mocap {
namespace {

bool has_extension(const std::filesystem::path& path, std::string_view extension) {
  return equal_ignoring_case(path.extension().string(), extension);
}

MotionFile read_amc_with_asf(const std::filesystem::path& path, const ReadOptions& options) {
  const auto asf_path = find_asf(path);
  auto skeleton = read_asf(asf_path, options);
  auto file = read_amc(path, skeleton, options);
  auto warnings = std::move(skeleton.warnings);
  const auto amc_name = lower_case(path.stem().string());
  if (!amc_name.starts_with(lower_case(asf_path.stem().string())))
    add_warning(warnings, {path},
                "read with " + asf_path.filename().string() + ", the only .asf in the folder");
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  file.warnings = std::move(warnings);
  return file;
}

}  // namespace

std::string ReadWarning::message() const {
  const std::string line = FormatError(location, text).what();
  return count == 1 ? line : line + " (and " + std::to_string(count - 1) + " more of this kind)";
}

void ReadOptions::validate() const {
  const auto require = [](bool is_fine, const std::string& name, double value, const char* range) {
    if (!is_fine) throw ConfigError(name + " is " + std::to_string(value) + ", must be " + range);
  };
  require(max_joints > 0, "max_joints", max_joints, "positive");
  require(max_depth > 0, "max_depth", max_depth, "positive");
  require(max_frames > 0, "max_frames", max_frames, "positive");
  require(amc_rate_hz >= 1.0 && amc_rate_hz <= 10'000.0, "amc_rate_hz", amc_rate_hz,
          "from 1 to 10000");
  require(bvh_unit_m >= 1e-6 && bvh_unit_m <= 1e3, "bvh_unit_m", bvh_unit_m, "from 1e-6 to 1000");
}

bool is_motion_file(const std::filesystem::path& path) {
  return has_extension(path, ".bvh") || has_extension(path, ".amc");
}

MotionFile read_motion_file(const std::filesystem::path& path, const ReadOptions& options) {
  if (has_extension(path, ".bvh")) return read_bvh(path, options);
  if (has_extension(path, ".amc")) return read_amc_with_asf(path, options);
  throw FormatError({path}, "is not a motion file", "the name must end in .bvh or .amc");
}

}  // namespace sparse_mocap
