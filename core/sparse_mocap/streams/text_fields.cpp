// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/text_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace sparse_mocap::streams {
namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace

std::vector<std::string_view> split_fields(std::string_view text, char separator) {
  std::vector<std::string_view> fields;
  const std::string_view ends = separator == ' ' ? kBlanks : std::string_view(&separator, 1);
  if (separator == ' ') text = trimmed(text);
  while (true) {
    const auto end = text.find_first_of(ends);
    fields.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    text.remove_prefix(end + 1);
    if (separator == ' ') text = trimmed(text);
  }
}

void append_number(Bytes& out, double value, int decimals) {
  std::array<char, 64> text;
  const double clean = std::isfinite(value) ? std::clamp(value, -1e15, 1e15) : 0.0;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), clean,
                                 std::chars_format::fixed, decimals);
  out.insert(out.end(), text.data(), end.ptr);
}

void append_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

}  // namespace sparse_mocap::streams
