// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/olng.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sparse_mocap::retrieval {
namespace {

struct Step {
  int query;
  int database;
};
constexpr std::array kWarping{Step{1, 1}, Step{1, 2}, Step{2, 1}};

}  // namespace

OnlineLazyNeighbourhoodGraph::OnlineLazyNeighbourhoodGraph(std::vector<std::int32_t> clip_of_frame,
                                                           const OlngConfig& config)
    : clip_of_frame_(std::move(clip_of_frame)), config_(config) {
  for (int columns = 0; columns < 3; ++columns)
    kept_after_[columns] = static_cast<float>(std::pow(config.forgetting, columns));
  for (auto& slots : slots_) slots.resize(clip_of_frame_.size());
}

void OnlineLazyNeighbourhoodGraph::reset() {
  columns_.clear();
  paths_.clear();
  now_ += 3;  // no stamp of the past can be met again
}

const OnlineLazyNeighbourhoodGraph::Node* OnlineLazyNeighbourhoodGraph::node_at(
    int columns_back, std::int32_t frame) const {
  const std::int64_t column = now_ - columns_back;
  if (frame < 0 || column < 0) return nullptr;
  const Slot& slot = slots_[column % 3][static_cast<std::size_t>(frame)];
  if (slot.stamp != column) return nullptr;
  const auto from_end = static_cast<std::size_t>(columns_back);
  if (from_end > columns_.size()) return nullptr;
  return &columns_[columns_.size() - from_end][static_cast<std::size_t>(slot.node)];
}

// Extends the best path that a step can come from; node.reward holds the node's own reward.
void OnlineLazyNeighbourhoodGraph::connect(Node& node) const {
  const auto clip = clip_of_frame_[static_cast<std::size_t>(node.frame)];
  const std::size_t num_steps = config_.is_warping ? kWarping.size() : 1;
  float best = 0.0F;
  for (std::size_t s = 0; s < num_steps; ++s) {
    const Step step = kWarping[s];
    const std::int32_t frame = node.frame - step.database;
    const Node* before = node_at(step.query, frame);
    if (before == nullptr || clip_of_frame_[static_cast<std::size_t>(frame)] != clip) continue;
    const float kept = kept_after_[step.query] * before->reward;
    if (kept <= best) continue;
    best = kept;
    node.previous = slots_[(now_ - step.query) % 3][static_cast<std::size_t>(frame)].node;
    node.columns_back = step.query;
    node.length = before->length + 1;
    node.total = before->total;
  }
  node.total += node.reward;
  node.reward += best;
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
    const auto& column = columns_[columns_.size() - static_cast<std::size_t>(back)];
    ancestor = &column[static_cast<std::size_t>(ancestor->previous)];
    if (back >= config_.window) {
      node.reward = node.total - ancestor->total;
      node.length = length;
      return;
    }
    ++length;
  }
}

void OnlineLazyNeighbourhoodGraph::extend(std::span<const Neighbour> neighbours) {
  const float charge =
      neighbours.empty() ? 0.0F : static_cast<float>(config_.penalty) * neighbours.back().distance;
  Column column;
  column.reserve(neighbours.size());
  for (const auto& neighbour : neighbours) {
    Node node;
    node.frame = neighbour.row;
    node.reward = charge - neighbour.distance;
    node.length = 1;
    connect(node);
    if (config_.window > 0) cut_to_window(node);
    column.push_back(node);
  }
  auto& slots = slots_[now_ % 3];
  for (std::size_t i = 0; i < column.size(); ++i)
    slots[static_cast<std::size_t>(column[i].frame)] = {now_, static_cast<std::int32_t>(i)};
  paths_.clear();
  for (const auto& node : column) {
    int previous_frame = -1;
    if (node.previous >= 0)
      previous_frame = columns_[columns_.size() - static_cast<std::size_t>(node.columns_back)]
                               [static_cast<std::size_t>(node.previous)]
                                   .frame;
    paths_.push_back({node.frame, node.reward, node.length, previous_frame});
  }
  columns_.push_back(std::move(column));
  // One more than the window: a step over a column may leave it from there.
  const auto kept = static_cast<std::size_t>(std::max(config_.window + 1, 2));
  if (columns_.size() > kept) columns_.pop_front();
  ++now_;
}

}  // namespace sparse_mocap::retrieval
