// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace sparse_mocap::path_regression {

// Two poses are alike whose joints are no farther apart than this on average, m.
constexpr double kAlike_m = 0.12;

// How far two poses are apart: the mean distance of their joints, m. Positions: 3 a joint, m,
// heading frame.
double pose_distance_m(const Eigen::Ref<const Eigen::VectorXf>& a,
                       const Eigen::Ref<const Eigen::VectorXf>& b);

// Whether a pose is like any of the others.
bool is_alike(const Eigen::Ref<const Eigen::VectorXf>& pose,
              std::span<const Eigen::VectorXf> others);

// A pose that many retrieved poses are like.
struct PoseMode {
  Eigen::VectorXf positions;
  double share = 0.0;  // of the weights of all retrieved poses
};

// What the retrieved poses of a frame say beside the motions that are known already.
struct FrameModes {
  double known_share = 0.0;     // of the weights: poses like the first known one
  std::vector<PoseMode> modes;  // unlike all known ones and each other, the heaviest first
};

// Finds modes by mean shift, each from the heaviest pose that is left. positions: one column a
// retrieved pose; weights: at least 0, sum 1; known: at least one pose. Modes with little weight
// are left out.
FrameModes modes_of(const Eigen::MatrixXf& positions, const Eigen::VectorXd& weights,
                    std::span<const Eigen::VectorXf> known);

// How likely a motion is that is in these modes, or where the known one is: the logarithm of the
// modes' shares beside the known one's, plus a preference so that the known one wins only where it
// weighs several times as much, minus what leaving it, returning, and jumps between modes cost.
double likelihood(std::span<const FrameModes> frames,
                  std::span<const std::optional<std::size_t>> modes, double frame_time_s);

// The likeliest of all (Viterbi): the mode of each frame; none: as known.
std::vector<std::optional<std::size_t>> likeliest_modes(std::span<const FrameModes> frames,
                                                        double frame_time_s);

}  // namespace sparse_mocap::path_regression
