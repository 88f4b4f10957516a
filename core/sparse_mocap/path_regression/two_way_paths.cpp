// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/two_way_paths.hpp"

#include <algorithm>

#include "sparse_mocap/retrieval/neighbourhood.hpp"

namespace sparse_mocap::path_regression {
namespace {

std::vector<std::int32_t> backwards(std::vector<std::int32_t> values) {
  std::reverse(values.begin(), values.end());
  return values;
}

}  // namespace

TwoWayPaths::TwoWayPaths(const std::vector<std::int32_t>& clip_of_frame,
                         const retrieval::OlngConfig& config)
    : forward_(clip_of_frame, config),
      backward_(backwards(clip_of_frame), config),
      last_frame_(static_cast<int>(clip_of_frame.size()) - 1),
      config_(config) {}

void TwoWayPaths::run(std::span<const std::vector<retrieval::Neighbour>> columns, int num_paths,
                      const std::function<void()>& reached) {
  constexpr std::size_t kPiece = 64;  // readings
  paths_.assign(columns.size(), {});
  forward_.reset();
  for (std::size_t t = 0; t < columns.size(); ++t) {
    if (t % kPiece == 0) reached();
    forward_.extend(columns[t]);
    paths_[t] = forward_.paths();
  }
  backward_.reset();
  std::vector<retrieval::Neighbour> mirrored;
  for (std::size_t t = columns.size(); t-- > 0;) {
    if (t % kPiece == 0) reached();
    mirrored = columns[t];
    for (auto& neighbour : mirrored) neighbour.row = last_frame_ - neighbour.row;
    backward_.extend(mirrored);
    const double charge =
        mirrored.empty() ? 0.0 : config_.penalty * static_cast<double>(mirrored.back().distance);
    for (std::size_t i = 0; i < mirrored.size(); ++i) {
      // Both directions count the node itself.
      const double own = charge - static_cast<double>(mirrored[i].distance);
      paths_[t][i].reward += backward_.paths()[i].reward - own;
      paths_[t][i].length += backward_.paths()[i].length - 1;
    }
    paths_[t] = retrieval::best_paths(paths_[t], num_paths);
    paths_[t].shrink_to_fit();
  }
}

}  // namespace sparse_mocap::path_regression
