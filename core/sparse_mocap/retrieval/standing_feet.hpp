// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

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

// How high ankles stand above the floor in a database. Recordings differ in it by several cm, with
// the place of the floor, shoes and markers; poses mixed from them need one floor.
class StandingHeights {
 public:
  explicit StandingHeights(const MotionDatabase& database);

  // The mean over the frames in which the ankle stands, m; left, right; each clip on the floor that
  // all share.
  const Eigen::Vector2d& usual_m() const { return usual_m_; }
  // How much lower that floor is than the clip's own, m: to be taken from its heights.
  double excess_m(int clip) const { return excess_m_[static_cast<std::size_t>(clip)]; }

 private:
  std::vector<double> excess_m_;
  Eigen::Vector2d usual_m_ = Eigen::Vector2d::Zero();
};

// Weighted votes and means of the retrieved frames. Where none of them stands, the step is zero and
// the height the usual one.
StandingFeet standing_feet(const MotionDatabase& database, const WeightedPaths& weighted,
                           const StandingHeights& heights);

// The mean height of the root above the floor that all clips share, m.
double root_height_m(const MotionDatabase& database, const WeightedPaths& weighted,
                     const StandingHeights& heights);

// The probability that a foot stands, from the vote of the retrieved frames and how much the
// specific force at the foot's own shank changes from reading to reading (m/s^2; NaN: not known).
double standing_certainty(double vote, double change_mps2);

}  // namespace sparse_mocap::retrieval
