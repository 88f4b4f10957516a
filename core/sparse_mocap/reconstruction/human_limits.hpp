// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "sparse_mocap/reconstruction/method.hpp"

namespace sparse_mocap {

// Keeps poses of a standard skeleton within what people can do: how far and how fast a joint turns.
//
// The limits are wide. They do not make a movement better, they end what nobody can do: a knee bent
// forwards, an arm that turns round within a frame.
class HumanLimits {
 public:
  HumanLimits(const Skeleton& skeleton, double rate_hz);

  // The next pose; after a reset the first.
  void apply(PoseEstimate& estimate);
  void reset() { before_.clear(); }

 private:
  struct Limit {
    double fastest_rad = 0.0;                // in one frame; 0: any
    double farthest_rad = 0.0;               // from rest; 0: any
    double least_rad = 0.0, most_rad = 0.0;  // of a joint with one axis; equal: any
  };

  Quat within_range(std::size_t joint, const Quat& rotation) const;

  const Skeleton& skeleton_;
  std::vector<Limit> limits_;
  std::vector<Quat> before_;
};

// How far a joint with one axis turns, rad.
struct HingeRange {
  double least_rad = 0.0, most_rad = 0.0;
};

// That of a joint of the standard skeleton, by its name; nothing: any, or it has more axes.
std::optional<HingeRange> hinge_range(std::string_view joint);

// The same methods, their poses within the limits.
std::unique_ptr<LiveMethod> within_human_limits(std::unique_ptr<LiveMethod> method);
std::unique_ptr<WholeTakeMethod> within_human_limits(std::unique_ptr<WholeTakeMethod> method);

}  // namespace sparse_mocap
