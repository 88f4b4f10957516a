// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap {

const std::vector<Channel>& all_channels();

// As the command line, Python and reports call it: "specific_force", ...
std::string_view name_of(Channel channel);

// Throws ConfigError naming the known channels.
Channel find_channel(std::string_view name);

// In the order of all_channels().
std::vector<std::string_view> names_of(Channels channels);

}  // namespace sparse_mocap
