// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::retrieval {

// What retrieved frames say of the feet; left, right. An ankle stands for its foot.
struct StandingFeet {
  Eigen::Vector2d certainty = Eigen::Vector2d::Zero();  // probability that the foot stands
  // How the ankles of feet that stand move into the frame, m, in the heading frame of the frame
  // before: little, for a foot rolls over the floor.
  std::array<Vec3, 2> step_m{Vec3::Zero(), Vec3::Zero()};
  Eigen::Vector2d height_m = Eigen::Vector2d::Zero();  // of those ankles, above the floor
};

// Weighted votes and means of the retrieved frames. Where none of them stands, the step is zero and
// the height what the database's standing ankles have, usual_height_m.
StandingFeet standing_feet(const MotionDatabase& database, const WeightedPaths& weighted,
                           const Eigen::Vector2d& usual_height_m);

// The mean height of the ankles in the database's frames in which they stand, m; left, right.
Eigen::Vector2d usual_standing_heights_m(const MotionDatabase& database);

// The probability that a foot stands, from the vote of the retrieved frames and how much the
// specific force at the foot's own shank changes from reading to reading (m/s^2; NaN: not known).
double standing_certainty(double vote, double change_mps2);

}  // namespace sparse_mocap::retrieval
