// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/root_motion.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/retrieval/standing_feet.hpp"

namespace sparse_mocap::path_regression {

// Where the points of a pose are, m, in the heading frame with the root at the origin: the joints'
// ends (3 joints numbers) and then, of each joint, the tips of its three axes as seen from its end
// (9 joints), each lever_m long. Ends say nothing of how a bone is turned about itself; tips do.
// Points of several poses can be averaged, whatever the rotations.
Eigen::VectorXd pose_points(const JointTransforms& pose, double lever_m);
void put_pose_points(const JointTransforms& pose, double lever_m, Eigen::VectorXd& points);

// How high limbs' ends should be above their beginnings.
struct InclinationTarget {
  std::vector<int> joints;
  std::vector<double> rises_m;
};

// What gravity directions say of the limbs that carry the sensors. Sensors without one, and those
// on trunk and head, take no part.
InclinationTarget inclination_target(const Skeleton& skeleton, const Reading& reading,
                                     std::span<const retrieval::Signal> signals);
void put_inclination_target(const Skeleton& skeleton, const Reading& reading,
                            std::span<const retrieval::Signal> signals, InclinationTarget& target);

// How fast a joint turns about the vertical in the world.
struct TurningTarget {
  int joint = 0;
  double rate_radps = 0.0;
};

// What gyroscopes say of the joints that they follow, for sensors that know which way is up too.
std::vector<TurningTarget> turning_targets(const Reading& reading,
                                           std::span<const retrieval::Signal> signals);
void put_turning_targets(const Reading& reading, std::span<const retrieval::Signal> signals,
                         std::vector<TurningTarget>& targets);

// What retrieval and sensors say of one frame.
struct FrameTarget {
  Eigen::VectorXd points;  // as pose_points: mean of the retrieved poses
  double agreement = 1.0;  // of the retrieved poses: how much their mean counts, at most 1
  Eigen::VectorXd step;    // how the points move into this frame; empty: not known
  InclinationTarget inclination;
  std::vector<TurningTarget> turning;  // in the order of the sensors, those that know it
  retrieval::RootRates root;
  retrieval::StandingFeet feet;
};

// Between two targets of one frame and reading: a where share is 0, b where it is 1. In between
// poses that are apart agree less; wide_spread_m is how far apart those are that count half.
FrameTarget blended(const FrameTarget& a, const FrameTarget& b, double share, double wide_spread_m);

// Poses that agree in one frame alone, between frames in which they do not, do so by chance, and
// would pull that frame out of its neighbours. The doubt (1 / agreement - 1) of each frame becomes
// the mean over the frames within `reach` of it.
void even_agreements(std::span<FrameTarget> targets, std::size_t reach);
// The same live: of a frame's agreement and the evened one of the frame before.
double evened_agreement(double agreement, double before);

}  // namespace sparse_mocap::path_regression
