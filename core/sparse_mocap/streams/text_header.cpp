// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/text_header.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "sparse_mocap/base/text_scanner.hpp"

namespace sparse_mocap::streams::text_line {
namespace {

using Words = std::vector<std::string_view>;

struct Quantity {
  Column first;  // of its axes
  Words names;
  std::string_view axes;
};

const auto& quantities() {
  static const std::array list{
      Quantity{Column::ax, {"a", "acc", "accel", "acceleration", "accelerometer"}, "xyz"},
      Quantity{Column::gx, {"g", "gyr", "gyro", "gyroscope", "omega"}, "xyz"},
      Quantity{Column::mx, {"m", "mag", "magn", "magnetometer"}, "xyz"},
      Quantity{Column::qw, {"q", "quat", "quaternion"}, "wxyz"},
  };
  return list;
}

const auto& single_names() {
  static const std::array<std::pair<Column, Words>, 3> list{{
      {Column::time, {"time", "t", "timestamp", "millis", "micros"}},
      {Column::sensor, {"sensor", "id", "name", "device", "sensorid", "deviceid"}},
      {Column::counter, {"counter", "count", "seq", "sequence", "packet", "packetcounter"}},
  }};
  return list;
}

bool has(const Words& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

// Lower-case letters and digits of a name up to a bracket: "Acc X [g]" is accx.
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : lower_case(name.substr(0, name.find_first_of("([")))) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_kept) out += c;
  }
  return out;
}

// The unit that ends a name, as in Time_ms, "time (us)" and millis.
std::string_view unit_of(std::string_view lower) {
  if (lower.find("millis") != std::string_view::npos) return "ms";
  if (lower.find("micros") != std::string_view::npos) return "us";
  while (!lower.empty() && (lower.back() == ')' || lower.back() == ']')) lower.remove_suffix(1);
  const auto end = lower.find_last_of(" _([-");
  return end == std::string_view::npos ? std::string_view() : lower.substr(end + 1);
}

}  // namespace

std::optional<Column> column_named(std::string_view name) {
  const auto lower = lower_case(name);
  const auto found = std::ranges::find(kColumnNames, lower);
  if (found == kColumnNames.end()) return std::nullopt;
  return static_cast<Column>(found - kColumnNames.begin());
}

std::optional<Column> header_column(std::string_view name) {
  if (const auto exact = column_named(name)) return exact;
  const std::string lower = lower_case(name);
  std::string word = plain(name);
  for (const auto& [column, names] : single_names()) {
    if (has(names, word)) return column;
    const auto unit = unit_of(lower);
    if (column == Column::time && !unit.empty() && word.ends_with(unit) &&
        has(names, std::string_view(word).substr(0, word.size() - unit.size())))
      return column;
  }
  if (word.empty()) return std::nullopt;
  for (const auto& quantity : quantities()) {
    const auto axis = quantity.axes.find(word.back());
    if (axis != std::string_view::npos &&
        has(quantity.names, std::string_view(word).substr(0, word.size() - 1)))
      return static_cast<Column>(static_cast<std::size_t>(quantity.first) + axis);
  }
  return std::nullopt;
}

double header_tick_s(std::string_view name, double default_s) {
  const std::string lower = lower_case(name);
  const auto unit = unit_of(lower);
  if (unit == "s" || unit == "sec" || unit == "seconds") return 1.0;
  if (unit == "ms") return 1e-3;
  if (unit == "us") return 1e-6;
  if (unit == "ns") return 1e-9;
  return default_s;
}

}  // namespace sparse_mocap::streams::text_line
