// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sparse_mocap {

// The value that the text holds. Refuses repeated keys, which would let two readers see two
// different files, and NUL, which the parser treats as the end of the text.
// Throws std::invalid_argument: "is not JSON", "repeats the key 'x'".
nlohmann::json parse_json_strictly(const std::string& text);

}  // namespace sparse_mocap
