// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/clip_names.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace sparse_mocap {
namespace {

std::vector<std::string> split_at_underscores(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '_') {
      parts.emplace_back();
    } else {
      parts.back().push_back(c);
    }
  }
  return parts;
}

bool is_number(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Matches one [..] set at the front of pattern; its length in consumed, 0 when it is not closed.
bool matches_set(std::string_view pattern, char c, std::size_t& consumed) {
  // A bracket that comes first is one of the set.
  const auto close = pattern.find(']', pattern.substr(1, 1) == "!" ? 3 : 2);
  consumed = 0;
  if (close == std::string_view::npos) return false;
  consumed = close + 1;
  auto set = pattern.substr(1, close - 1);
  const bool is_negated = set.front() == '!';
  if (is_negated) set.remove_prefix(1);
  bool is_in = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (i + 2 < set.size() && set[i + 1] == '-') {
      is_in = is_in || (lower(set[i]) <= c && c <= lower(set[i + 2]));
      i += 2;
    } else {
      is_in = is_in || lower(set[i]) == c;
    }
  }
  return is_in != is_negated;
}

}  // namespace

ClipLabels labels_of(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  const auto parts = split_at_underscores(stem);
  if (parts.size() >= 4 && parts[0] == "HDM") return {stem, parts[1], parts[2]};
  if (parts.size() >= 2 && is_number(parts[0]) && is_number(parts[1]))
    return {stem, parts[0], "trial" + parts[1]};
  if (parts.size() >= 3) return {stem, parts[0], parts[1]};
  return {stem, path.parent_path().filename().string(), stem};
}

bool matches_glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0;
  std::size_t star = std::string_view::npos, star_text = 0;
  while (t < text.size()) {
    const char c = lower(text[t]);
    std::size_t consumed = 1;
    bool is_match = false;
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
      continue;
    }
    if (p < pattern.size()) {
      if (pattern[p] == '[') {
        is_match = matches_set(pattern.substr(p), c, consumed);
        if (consumed == 0) {
          consumed = 1;
          is_match = c == '[';
        }
      } else {
        is_match = pattern[p] == '?' || lower(pattern[p]) == c;
      }
    }
    if (is_match) {
      p += consumed;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace sparse_mocap
