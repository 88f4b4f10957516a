// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/motion_file.hpp"

#include <cctype>
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

// Letters as 'a', digits as '9': "HDM_bd" and "HDM_mm" are of one form.
std::string form_of(std::string_view text) {
  std::string form;
  for (const char c : text)
    form += c >= '0' && c <= '9' ? '9' : std::isalpha(static_cast<unsigned char>(c)) != 0 ? 'a' : c;
  return form;
}

// Whether the .amc names an actor as the .asf does, but another one: 02_01.amc and 35.asf.
bool is_of_another_actor(const std::filesystem::path& amc, const std::filesystem::path& asf) {
  const std::string actor = lower_case(asf.stem().string());
  const std::string named = lower_case(amc.stem().string());
  if (named.size() <= actor.size() || std::isalnum(static_cast<unsigned char>(named[actor.size()])))
    return false;
  const std::string begin = named.substr(0, actor.size());
  return begin != actor && form_of(begin) == form_of(actor);
}

void check_found_asf(const std::filesystem::path& amc, const std::filesystem::path& asf,
                     const ReadOptions& options, std::vector<ReadWarning>& warnings) {
  if (lower_case(amc.stem().string()).starts_with(lower_case(asf.stem().string()))) return;
  const std::string name = asf.filename().string();
  const bool is_other = is_of_another_actor(amc, asf);
  if (is_other && options.refuse_other_asf)
    throw FormatError({amc}, "the only .asf in its folder, " + name + ", is of another actor",
                      "put its own there, or choose one with --asf");
  add_warning(warnings, {amc},
              "read with " + name + ", the only .asf in the folder" +
                  (is_other ? ", which seems to be of another actor" : ""));
}

MotionFile read_acclaim(const std::filesystem::path& path, const ReadOptions& options) {
  const bool is_skeleton = has_extension(path, ".asf");
  const bool is_found = !is_skeleton && options.asf.empty();
  const auto asf_path = is_skeleton ? path : is_found ? find_asf(path) : options.asf;
  const auto skeleton = read_asf(asf_path, options);
  MotionFile file{{skeleton.skeleton, 1.0 / options.amc_rate_hz, {}, {}, {}}, {}};
  if (!is_skeleton) file = read_amc(path, skeleton, options);
  std::vector<ReadWarning> warnings = skeleton.warnings;
  if (is_found) check_found_asf(path, asf_path, options, warnings);
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  file.warnings = std::move(warnings);
  if (options.unit_m || options.up != Axis::y)
    change_world(file.motion,
                 options.unit_m.value_or(skeleton.metres_per_unit) / skeleton.metres_per_unit,
                 rotation_to_y(options.up));
  return file;
}

MotionFile read_by_ending(const std::filesystem::path& path, const ReadOptions& options) {
  const auto reader = options.further_readers.find(lower_case(path.extension().string()));
  if (reader != options.further_readers.end()) return reader->second(path, options);
  if (has_extension(path, ".bvh")) return read_bvh(path, options);
  if (has_extension(path, ".amc")) return read_acclaim(path, options);
  if (options.allow_no_frames && has_extension(path, ".asf")) return read_acclaim(path, options);
  throw FormatError({path}, "is not a motion file", "the name must end in .bvh or .amc");
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
  const double rate = rate_hz.value_or(1.0);
  require(rate >= 1.0 && rate <= 10'000.0, "rate_hz", rate, "from 1 to 10000");
  const double unit = unit_m.value_or(1.0);
  require(unit >= 1e-6 && unit <= 1e3, "unit_m", unit, "from 1e-6 to 1000");
}

bool is_motion_file(const std::filesystem::path& path, const ReadOptions& options) {
  return has_extension(path, ".bvh") || has_extension(path, ".amc") ||
         options.further_readers.contains(lower_case(path.extension().string()));
}

MotionFile read_motion_file(const std::filesystem::path& path, const ReadOptions& options) {
  MotionFile file = read_by_ending(path, options);
  if (options.rate_hz) file.motion.frame_time_s = 1.0 / *options.rate_hz;
  return file;
}

}  // namespace sparse_mocap
