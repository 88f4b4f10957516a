// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace sparse_mocap {

// A format that is not read here, and what to do with such a file.
struct OtherFormat {
  std::string_view mark;  // the name's ending, or the first bytes; lower case
  const char* what;       // "is an FBX file"
  const char* remedy;
};

// By the name's ending; nullptr when it is none of those known.
const OtherFormat* other_format_by_ending(const std::filesystem::path& path);

// By the first bytes, whatever the name says; nullptr when it is none of those known.
const OtherFormat* other_format_by_content(std::string_view content);

}  // namespace sparse_mocap
