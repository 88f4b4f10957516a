// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/olng.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sparse_mocap/base/sort_keys.hpp"

namespace sparse_mocap::retrieval {
namespace {

// A node in the order of frames.
std::int32_t frame_of(std::uint64_t key) { return static_cast<std::int32_t>(key >> 32); }
std::size_t index_of(std::uint64_t key) { return key & 0xFFFF'FFFFULL; }
std::uint64_t key_of(std::int32_t frame, std::size_t index) {
  return (static_cast<std::uint64_t>(frame) << 32) | index;
}

}  // namespace

OnlineLazyNeighbourhoodGraph::OnlineLazyNeighbourhoodGraph(std::vector<std::int32_t> clip_of_frame,
                                                           const OlngConfig& config)
    : clip_of_frame_(std::move(clip_of_frame)), config_(config), steps_{{1, 1}} {
  if (config.is_warping) steps_ = {{1, 1}, {1, 2}, {2, 1}};
}

void OnlineLazyNeighbourhoodGraph::reset() {
  columns_.clear();
  paths_.clear();
}

// Extends each node's best path so far by this step where that is better. Both columns are walked
// once, in the order of their frames.
void OnlineLazyNeighbourhoodGraph::connect(Column& column, const Step& step) const {
  if (static_cast<std::size_t>(step.query) > columns_.size()) return;
  const Column& earlier = column_before(step.query);
  const auto forgotten = static_cast<float>(std::pow(config_.forgetting, step.query));
  auto from = earlier.by_frame.begin();
  for (const std::uint64_t key : column.by_frame) {
    const std::int32_t frame = frame_of(key), wanted = frame - step.database;
    while (from != earlier.by_frame.end() && frame_of(*from) < wanted) ++from;
    if (from == earlier.by_frame.end()) return;
    if (frame_of(*from) != wanted) continue;
    Node& node = column.nodes[index_of(key)];
    const Node& before = earlier.nodes[index_of(*from)];
    const float kept = forgotten * before.reward;
    if (kept <= node.before) continue;
    if (clip_of_frame_[static_cast<std::size_t>(wanted)] !=
        clip_of_frame_[static_cast<std::size_t>(frame)])
      continue;
    node.before = kept;
    node.previous = static_cast<std::int32_t>(index_of(*from));
    node.columns_back = step.query;
    node.length = before.length + 1;
    node.total = before.total;
  }
}

// Takes off what the path earned before the window: total now minus total of the ancestor that has
// left it.
void OnlineLazyNeighbourhoodGraph::cut_to_window(Node& node) const {
  int back = 0;
  int length = 1;
  const Node* ancestor = &node;
  while (ancestor->previous >= 0) {
    back += ancestor->columns_back;
    if (static_cast<std::size_t>(back) > columns_.size()) break;
    ancestor = &column_before(back).nodes[static_cast<std::size_t>(ancestor->previous)];
    if (back >= config_.window) {
      node.reward = node.total - ancestor->total;
      node.length = length;
      return;
    }
    ++length;
  }
}

// An empty column, in the memory of one that no path reaches any more.
OnlineLazyNeighbourhoodGraph::Column OnlineLazyNeighbourhoodGraph::reused_column() {
  Column column;
  // One more than the window: a step over a column may leave it from there.
  const auto kept = static_cast<std::size_t>(std::max(config_.window + 1, 2));
  if (columns_.size() > kept) {
    column = std::move(columns_.front());
    columns_.erase(columns_.begin());
  }
  column.nodes.clear();
  column.by_frame.clear();
  return column;
}

void OnlineLazyNeighbourhoodGraph::extend(std::span<const Neighbour> neighbours) {
  const float charge =
      neighbours.empty() ? 0.0F : static_cast<float>(config_.penalty) * neighbours.back().distance;
  Column column = reused_column();
  for (const auto& neighbour : neighbours) {
    column.by_frame.push_back(key_of(neighbour.row, column.nodes.size()));
    Node& node = column.nodes.emplace_back();
    node.frame = neighbour.row;
    node.own = charge - neighbour.distance;
    node.length = 1;
  }
  sort_keys(column.by_frame, scratch_);
  for (const Step& step : steps_) connect(column, step);
  paths_.clear();
  for (auto& node : column.nodes) {
    node.total += node.own;
    node.reward = node.own + node.before;
    if (config_.window > 0) cut_to_window(node);
    int previous_frame = -1;
    if (node.previous >= 0)
      previous_frame =
          column_before(node.columns_back).nodes[static_cast<std::size_t>(node.previous)].frame;
    paths_.push_back({node.frame, node.reward, node.length, previous_frame});
  }
  columns_.push_back(std::move(column));
}

}  // namespace sparse_mocap::retrieval
