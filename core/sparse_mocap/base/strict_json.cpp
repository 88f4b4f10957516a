// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/strict_json.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

namespace sparse_mocap {

nlohmann::json parse_json_strictly(const std::string& text) {
  using nlohmann::json;
  if (text.find('\0') != std::string::npos) throw std::invalid_argument("is not JSON");
  std::vector<std::set<std::string>> open_objects;
  const auto watch = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) open_objects.emplace_back();
    if (event == json::parse_event_t::object_end) open_objects.pop_back();
    if (event == json::parse_event_t::key &&
        !open_objects.back().insert(value.get<std::string>()).second)
      throw std::invalid_argument("repeats the key '" + value.get<std::string>() + "'");
    return true;
  };
  try {
    return json::parse(text, watch);
  } catch (const json::exception&) {
    throw std::invalid_argument("is not JSON");
  }
}

}  // namespace sparse_mocap
