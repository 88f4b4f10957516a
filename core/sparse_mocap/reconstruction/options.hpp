// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

// One setting of a method, as command lines, panels and help texts show it.
struct OptionInfo {
  enum class Kind { number, integer, flag, choice };

  std::string name;  // with its unit, unless it has none
  Kind kind = Kind::number;
  std::string help;
  double lowest = 0.0, highest = 0.0;  // of numbers and integers, both allowed
  std::vector<std::string> choices;    // of choices
  std::string default_value;           // as it would be written
};

// Settings by name, written as text: "4096", "0.5", "true", "kernel".
using OptionValues = std::map<std::string, std::string, std::less<>>;

// Reads text as the option asks for it: a number, an index in choices, or 0 and 1 of a flag. Throws
// ConfigError naming the option, the text and what is possible.
double parsed_option(const OptionInfo& option, std::string_view text);
std::string written_option(const OptionInfo& option, double value);

// Throws ConfigError that lists the options' names, the likeliest first.
[[noreturn]] void throw_unknown_option(std::string_view name, const std::vector<OptionInfo>& known);

// The options of a method and the members of its configuration that they set.
template <typename Config>
class OptionTable {
 public:
  OptionTable& number(const char* name, double Config::*member, double lowest, double highest,
                      const char* help) {
    return add({name, OptionInfo::Kind::number, help, lowest, highest, {}, {}}, member);
  }
  // Of a part of the configuration.
  template <typename Part>
  OptionTable& number(const char* name, Part Config::*part, double Part::*member, double lowest,
                      double highest, const char* help) {
    entries_.push_back({{name, OptionInfo::Kind::number, help, lowest, highest, {}, {}},
                        [=](const Config& c) { return c.*part.*member; },
                        [=](Config& c, double value) { c.*part.*member = value; }});
    return *this;
  }
  OptionTable& integer(const char* name, int Config::*member, int lowest, int highest,
                       const char* help) {
    return add({name,
                OptionInfo::Kind::integer,
                help,
                static_cast<double>(lowest),
                static_cast<double>(highest),
                {},
                {}},
               member);
  }
  OptionTable& flag(const char* name, bool Config::*member, const char* help) {
    return add({name, OptionInfo::Kind::flag, help, 0.0, 1.0, {}, {}}, member);
  }
  // The enumerators count from 0, in the order of choices.
  template <typename Enum>
  OptionTable& choice(const char* name, Enum Config::*member, std::vector<std::string> choices,
                      const char* help) {
    return add({name, OptionInfo::Kind::choice, help, 0.0, 0.0, std::move(choices), {}}, member);
  }

  // The options with the values that a configuration has.
  std::vector<OptionInfo> described(const Config& config) const {
    std::vector<OptionInfo> options;
    for (const auto& entry : entries_) {
      options.push_back(entry.info);
      options.back().default_value = written_option(entry.info, entry.get(config));
    }
    return options;
  }

  // Throws ConfigError for an unknown name or an impossible value.
  void apply(const OptionValues& values, Config& config) const {
    for (const auto& [name, text] : values) {
      const Entry* found = nullptr;
      for (const auto& entry : entries_)
        if (entry.info.name == name) found = &entry;
      if (found == nullptr) throw_unknown_option(name, described(config));
      found->set(config, parsed_option(found->info, text));
    }
  }

  // Throws ConfigError naming the first setting that is outside its range.
  void validate(const Config& config) const {
    for (const auto& entry : entries_)
      parsed_option(entry.info, written_option(entry.info, entry.get(config)));
  }

 private:
  struct Entry {
    OptionInfo info;
    std::function<double(const Config&)> get;
    std::function<void(Config&, double)> set;
  };

  template <typename Value>
  OptionTable& add(OptionInfo info, Value Config::*member) {
    entries_.push_back(
        {std::move(info), [member](const Config& c) { return static_cast<double>(c.*member); },
         [member](Config& c, double value) { c.*member = static_cast<Value>(value); }});
    return *this;
  }

  std::vector<Entry> entries_;
};

}  // namespace sparse_mocap
