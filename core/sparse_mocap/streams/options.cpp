// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/options.hpp"

#include <algorithm>
#include <charconv>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/nearest_name.hpp"
#include "sparse_mocap/base/text_scanner.hpp"

namespace sparse_mocap::streams {
namespace {

std::string plain(double value) {
  const auto text = std::to_string(value);
  const auto end = text.find_last_not_of('0');
  return text.substr(0, text[end] == '.' ? end : end + 1);
}

}  // namespace

Options::Options(std::string_view driver, std::span<const OptionSpec> specs, const OptionMap& given)
    : driver_(driver) {
  std::vector<std::string_view> names;
  for (const auto& spec : specs) {
    names.push_back(spec.name);
    values_[spec.name] = spec.default_value;
  }
  for (const auto& [name, value] : given) {
    if (values_.find(name) == values_.end())
      throw ConfigError(
          "driver " + driver_ + " has no option " + in_quotes(name) +
          (names.empty() ? "; it has no options"
                         : "; the nearest is '" + std::string(nearest_name(name, names)) + "'"));
    values_[name] = value;
  }
}

const std::string& Options::text(std::string_view name) const { return values_.find(name)->second; }

double Options::number(std::string_view name, double lowest, double highest) const {
  double value = 0.0;
  if (parse_number(text(name), value) != NumberStatus::ok || value < lowest || value > highest)
    fail(name, "a number from " + plain(lowest) + " to " + plain(highest));
  return value;
}

int Options::integer(std::string_view name, int lowest, int highest) const {
  std::string_view digits = text(name);
  const bool is_hexadecimal = digits.starts_with("0x");
  if (is_hexadecimal) digits.remove_prefix(2);
  int value = 0;
  const auto* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value, is_hexadecimal ? 16 : 10);
  if (error != std::errc() || stop != end || value < lowest || value > highest)
    fail(name, "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
  return value;
}

bool Options::flag(std::string_view name) const { return choice(name, {"false", "true"}) == 1; }

int Options::choice(std::string_view name, std::initializer_list<std::string_view> choices) const {
  std::string expected;
  int index = 0;
  for (const auto& known : choices) {
    if (known == text(name)) return index;
    expected += (index++ == 0 ? "" : ", ") + std::string(known);
  }
  fail(name, "one of " + expected);
}

std::vector<std::string> Options::list(std::string_view name) const {
  std::vector<std::string> items;
  std::string_view rest = text(name);
  while (!rest.empty()) {
    const auto end = std::min(rest.find(','), rest.size());
    items.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return items;
}

void Options::fail(std::string_view name, const std::string& expected) const {
  throw ConfigError("option " + std::string(name) + " of driver " + driver_ + " is " +
                    in_quotes(text(name)) + "; it must be " + expected);
}

}  // namespace sparse_mocap::streams
