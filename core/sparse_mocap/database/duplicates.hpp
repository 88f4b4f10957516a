// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <optional>

#include "sparse_mocap/database/database_rows.hpp"

namespace sparse_mocap {

// How far two clips on one skeleton at one rate are apart, after the shift in time (of at most
// three rows) that fits best: RMS over joints and frames, m, joints in the heading frame; root
// motion is weighed in.
struct ClipDistance {
  double apart_m = 0.0;
  double step_m = 0.0;  // how far the joints move from one row to the next

  // Whether they show one recording. Its formats agree within a hundredth of a millimetre, its
  // copies at other frame rates by what filters and interpolation make of a step: mostly less than
  // a tenth of it. Two performances of one movement differ by 0.43 of a step and more (the nearest
  // of 686,000 pairs of clips of HDM05, CMU and Bandai Namco).
  bool is_same_motion() const { return apart_m < std::max(0.002, 0.25 * step_m); }
};

// Nothing where the clips are more than about 0.1 m apart, or their lengths differ by more than
// such a shift.
std::optional<ClipDistance> clip_distance(const DatabaseRows& a, const DatabaseRows& b);

// Finds clips that show the same motion as one that was added before, whatever file they came from.
class DuplicateFinder {
 public:
  // The id of a clip that the rows' motion is the same as; the one added first if there are more.
  std::optional<int> find(const DatabaseRows& rows) const;
  void add(int id, const DatabaseRows& rows);

 private:
  struct Known {
    int id = 0;
    DatabaseRows::Rows features;
  };

  std::multimap<int, Known> by_length_;
};

}  // namespace sparse_mocap
