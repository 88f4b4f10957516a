// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::retrieval {

struct OlngConfig {
  // A column that a path leaves unmatched costs penalty times the distance of the column's farthest
  // neighbour.
  double penalty = 1.0;
  // How much a column counts one column later; 1 with a window forgets all at once instead.
  double forgetting = 0.95;
  // The paper's M: paths reach back at most this many columns; 0 means without limit.
  int window = 0;
  // Whether paths may go at half and at double speed, or only at that of the database.
  bool is_warping = true;
};

// A chain of database frames that explains the last readings.
//
// The paper ranks paths by cost. Every column of the window costs something (its distance where the
// path matches it, its penalty where not), so cost = const - reward with
// reward = sum over matched columns of (penalty - distance): long and close paths win, and the rank
// needs no count of columns.
struct Path {
  int frame = 0;  // the database frame at its end
  double reward = 0.0;
  int length = 0;           // matched columns
  int previous_frame = -1;  // the frame before, -1 when the path begins here
};

// The online lazy neighbourhood graph (Tautges et al. 2011, section 4).
//
// One column a reading; its nodes are the reading's nearest database frames. Edges are strictly
// monotonous in time and warp by a factor of two at most: (query, database) steps (1,1), (1,2) and
// (2,1), never from one clip into another. One best path ends in each node of the last column.
class OnlineLazyNeighbourhoodGraph {
 public:
  // clip_of_frame[n] names the clip of database frame n.
  OnlineLazyNeighbourhoodGraph(std::vector<std::int32_t> clip_of_frame, const OlngConfig& config);

  void reset();
  // Adds the next reading's column, O(K). Neighbours as KnnIndex::search gives them (ascending).
  void extend(std::span<const Neighbour> neighbours);
  // The best path into each node of the last column, in the order of its neighbours.
  const std::vector<Path>& paths() const { return paths_; }

 private:
  struct Node {
    std::int32_t frame = 0;
    float own = 0.0F;     // what matching it earns
    float before = 0.0F;  // the reward of the best path that it extends
    float reward = 0.0F;  // of the best path into it, forgetting applied
    float total = 0.0F;   // the same without forgetting or window, to cut windows exactly
    std::int32_t length = 0;
    std::int32_t previous = -1;  // node index in the column columns_back before
    std::int32_t columns_back = 0;
  };
  struct Column {
    std::vector<Node> nodes;  // in the order of the neighbours
    std::vector<std::uint64_t>
        by_frame;  // a node's frame and, in the lower half, its index; sorted
  };
  struct Step {
    int query;  // columns
    int database;
  };

  Column reused_column();
  void connect(Column& column, const Step& step) const;
  void cut_to_window(Node& node) const;
  const Column& column_before(int columns_back) const {
    return columns_[columns_.size() - static_cast<std::size_t>(columns_back)];
  }

  std::vector<std::int32_t> clip_of_frame_;
  OlngConfig config_;
  std::vector<Step> steps_;
  std::vector<Column> columns_;  // newest last
  std::vector<Path> paths_;
  std::vector<std::uint64_t> scratch_;
};

}  // namespace sparse_mocap::retrieval
