// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap {

// Gives the poses of one performance feet, toes and hands: what the retrieved frames say of them,
// relaxed where these know nothing, smooth in time. A foot lies level on the floor (y = 0) while it
// stands, unless its heel or its toes are raised, and toes stay above the floor.
class ExtremityTrack {
 public:
  // Poses of a skeleton other than the standard one stay as they are.
  ExtremityTrack(const Skeleton& method_skeleton, double rate_hz);

  // Of the poses that come out: the method's with extremities.
  const Skeleton& skeleton() const { return skeleton_; }

  // Live: each pose after those before it.
  void complete(PoseEstimate& estimate);
  // A whole take, smoothed in both directions.
  void complete(std::vector<PoseEstimate>& take) const;

  void reset() { last_.reset(); }

 private:
  // Rotations in their parents, and how certain it is that each foot stands.
  struct State {
    std::array<Quat, kNumExtremities> rotations;
    Eigen::Vector2d stands;
  };

  State wanted(const PoseEstimate& estimate) const;
  static State between(const State& from, const State& to, double share);
  void append(const State& state, PoseEstimate& estimate) const;

  Skeleton skeleton_;
  bool is_standard_ = false;
  double frame_time_s_;
  std::array<Quat, kNumExtremities> relaxed_;
  std::optional<State> last_;
};

}  // namespace sparse_mocap
