// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"

namespace sparse_mocap {

// When a foot stands, from how certain a method is and how its ankle moves.
struct StandOptions {
  double least_certainty = 0.5;  // 0 to 1, of the method's contacts
  double fastest_mps = 0.5;      // an ankle that is faster does not stand
  double highest_m = 0.06;       // above where the ankle is while the foot is flat on the floor
};

// Frames [begin, end) in which a foot stands.
struct Stand {
  int begin = 0;
  int end = 0;
};

// ankle: 3 x T (m), its floor at y = 0; certainty: T, of the contact. Short gaps are closed and
// short stands dropped.
std::vector<Stand> find_stands(const Eigen::Matrix3Xd& ankle, const Eigen::VectorXd& certainty,
                               double ankle_height_m, double frame_time_s,
                               const StandOptions& options);

// What has to be added to the ankle's path (3 x T, m) for it to stay where it stands, at the height
// of a flat foot. While the foot moves, the correction of one stand passes smoothly into that of
// the next (Kovar et al. 2002, section 4).
Eigen::Matrix3Xd stand_corrections(const Eigen::Matrix3Xd& ankle, const std::vector<Stand>& stands,
                                   double ankle_height_m);

// T values: 1 while the foot stands, and down to 0 within a time before and after.
Eigen::VectorXd stand_weights(const std::vector<Stand>& stands, int num_frames,
                              double frames_to_zero);

}  // namespace sparse_mocap
