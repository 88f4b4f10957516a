// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace sparse_mocap {
namespace {

std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::iota(before.begin(), before.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> now{i};
    for (std::size_t j = 1; j <= b.size(); ++j)
      now.push_back(
          std::min({before[j] + 1, now[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])}));
    before = std::move(now);
  }
  return before.back();
}

}  // namespace

std::string_view nearest_name(std::string_view wanted, std::span<const std::string_view> names) {
  const auto nearest = std::min_element(names.begin(), names.end(), [&](auto a, auto b) {
    return edits_between(wanted, a) < edits_between(wanted, b);
  });
  return nearest == names.end() ? std::string_view() : *nearest;
}

}  // namespace sparse_mocap
