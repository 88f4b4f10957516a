// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "sparse_mocap/liu2011/map_estimate.hpp"
#include "sparse_mocap/liu2011/motion_examples.hpp"
#include "sparse_mocap/liu2011/worn_sensors.hpp"

namespace sparse_mocap::liu2011 {

// Where sensors put a pose: the heading frame of the pose in their world, and how far they are from
// where they are measured then.
struct Placement {
  HeadingFrame frame;
  double squared_error = 0.0;  // in sigma_data
};

// The turn about the vertical and the place that bring a pose's sensors nearest to the measured
// ones, in closed form. modelled: the sensors in the pose's own heading frame, in the order of
// observed. A height is not moved. Without positions the place is the origin, without anything
// measured it faces forward.
Placement placed(std::span<const Observation> observed, std::span<const SensorPose> modelled,
                 const ControlWeights& weights);

// How a performance can begin: the last m poses before its first reading, the newest first, in the
// world. They are those of the database frame whose pose, wherever it stands, puts the sensors
// nearest to where they are measured.
class Start {
 public:
  // is_searched: one flag a frame.
  Start(const MotionExamples& examples, const std::vector<bool>& is_searched);

  std::vector<BodyPose> history(std::span<const Observation> observed,
                                const ControlWeights& weights, int num_poses,
                                std::size_t most_frames = kMostFrames) const;

  static constexpr std::size_t kMostFrames = 100'000;  // of larger databases every n-th is tried

 private:
  const MotionExamples& examples_;
  std::vector<int> frames_;
};

}  // namespace sparse_mocap::liu2011
