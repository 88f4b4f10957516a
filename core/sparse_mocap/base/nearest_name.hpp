// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace sparse_mocap {

// The name that is spelt most like the wanted one: the fewest letters to change, add or drop
// (Levenshtein 1966), the first of several. Empty when there are no names.
std::string_view nearest_name(std::string_view wanted, std::span<const std::string_view> names);

}  // namespace sparse_mocap
