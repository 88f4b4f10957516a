// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparse_mocap::streams {

struct OptionSpec {
  std::string name;
  std::string default_value;
  std::string description;
};

using OptionMap = std::map<std::string, std::string, std::less<>>;

// A driver's options as texts; the getters convert them and throw ConfigError
// naming the option, its value and the allowed values.
class Options {
 public:
  // Throws ConfigError for a name that the driver does not have, naming the nearest.
  Options(std::string_view driver, std::span<const OptionSpec> specs, const OptionMap& given);

  const std::string& text(std::string_view name) const;
  bool is_empty(std::string_view name) const { return text(name).empty(); }
  double number(std::string_view name, double lowest, double highest) const;
  int integer(std::string_view name, int lowest, int highest) const;  // also hexadecimal: 0x206
  bool flag(std::string_view name) const;
  // The index of the value among these.
  int choice(std::string_view name, std::initializer_list<std::string_view> choices) const;
  std::vector<std::string> list(std::string_view name) const;  // separated by commas
  [[noreturn]] void fail(std::string_view name, const std::string& expected) const;

 private:
  std::string driver_;
  OptionMap values_;
};

}  // namespace sparse_mocap::streams
