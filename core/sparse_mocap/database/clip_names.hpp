// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sparse_mocap {

struct ClipLabels {
  std::string name;
  std::string actor;
  std::string motion_class;
};

// Who does what, from a file's name: HDM05 (HDM_<actor>_<class>_<take>_<rate>), CMU
// (<subject>_<trial>), or <actor>_<class>_<take>; otherwise the folder is the actor.
ClipLabels labels_of(const std::filesystem::path& path);

// Whether a shell pattern (* ? [a-z] [!a-z]) matches the whole text, ignoring case.
bool matches_glob(std::string_view pattern, std::string_view text);

}  // namespace sparse_mocap
