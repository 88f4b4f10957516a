// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/streams/options.hpp"

namespace sparse_mocap::fuzz {

struct StreamSetting {
  std::string driver;
  streams::OptionMap options;
};

// The parsers that try_streams knows; the first byte of its input chooses one.
const std::vector<StreamSetting>& stream_settings();

// [which parser][how the bytes are cut][bytes of a device]: samples must be plausible, and the same
// however the bytes are cut. Returns what is wrong, "" if nothing is.
std::string try_streams(std::string_view input);

}  // namespace sparse_mocap::fuzz
