// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/options.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "sparse_mocap/base/nearest_name.hpp"

namespace sparse_mocap {
namespace {

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::string expected(const OptionInfo& option) {
  switch (option.kind) {
    case OptionInfo::Kind::flag:
      return "true or false";
    case OptionInfo::Kind::choice:
      return "one of " + joined(option.choices);
    case OptionInfo::Kind::integer:
    case OptionInfo::Kind::number:
      break;
  }
  return std::string(option.kind == OptionInfo::Kind::integer ? "a whole number" : "a number") +
         " from " + shortest(option.lowest) + " to " + shortest(option.highest);
}

[[noreturn]] void throw_impossible(const OptionInfo& option, std::string_view text) {
  throw ConfigError(option.name + " must be " + expected(option) + ", got '" + std::string(text) +
                    "'");
}

}  // namespace

double parsed_option(const OptionInfo& option, std::string_view text) {
  using Kind = OptionInfo::Kind;
  if (option.kind == Kind::flag) {
    if (text == "true" || text == "1") return 1.0;
    if (text == "false" || text == "0") return 0.0;
    throw_impossible(option, text);
  }
  if (option.kind == Kind::choice) {
    for (std::size_t i = 0; i < option.choices.size(); ++i)
      if (option.choices[i] == text) return static_cast<double>(i);
    throw_impossible(option, text);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  const bool is_in_range = value >= option.lowest && value <= option.highest;  // not of NaN
  const bool is_whole = option.kind == Kind::number || value == std::floor(value);
  if (!is_number || !is_in_range || !is_whole) throw_impossible(option, text);
  return value;
}

std::string written_option(const OptionInfo& option, double value) {
  if (option.kind == OptionInfo::Kind::flag) return value != 0.0 ? "true" : "false";
  if (option.kind == OptionInfo::Kind::choice)
    return option.choices.at(static_cast<std::size_t>(value));
  return shortest(value);
}

void throw_unknown_option(std::string_view name, const std::vector<OptionInfo>& known) {
  if (known.empty())
    throw ConfigError("unknown option '" + std::string(name) + "'; this method has none");
  std::vector<std::string> names;
  for (const auto& option : known) names.push_back(option.name);
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw ConfigError("unknown option '" + std::string(name) + "'; did you mean '" +
                    std::string(nearest_name(name, views)) + "'? Known are " + joined(names));
}

}  // namespace sparse_mocap
