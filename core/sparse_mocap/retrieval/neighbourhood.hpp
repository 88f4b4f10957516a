// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/retrieval/olng.hpp"

namespace sparse_mocap::retrieval {

// The best paths, the best one first, and how much each counts.
struct WeightedPaths {
  std::vector<Path> paths;
  Eigen::VectorXd weights;  // W, sum 1
};

// The poses that the best paths lead to (Tautges et al. 2011, section 5): one column a path.
struct Neighbourhood : WeightedPaths {
  Eigen::MatrixXd angles;     // Q, 43 x I, rad, each as near to the best path's as it can be put
  Eigen::MatrixXd positions;  // X, 63 x I, m, heading frame
};

// The num_paths paths of greatest reward, ties by frame.
std::vector<Path> best_paths(std::span<const Path> paths, int num_paths);
void put_best_paths(std::span<const Path> paths, int num_paths, std::vector<Path>& best);

// Equation (1) with cost = const - reward, for paths sorted by falling reward: the worst path
// counts nothing, equal rewards count alike.
Eigen::VectorXd linear_weights(std::span<const Path> paths);
void put_linear_weights(std::span<const Path> paths, Eigen::VectorXd& weights);

// exp(sharpness * (reward - best) / standard deviation of the rewards), normalised.
Eigen::VectorXd softmax_weights(std::span<const Path> paths, double sharpness);
void put_softmax_weights(std::span<const Path> paths, double sharpness, Eigen::VectorXd& weights);

// Looks the paths up in the database. near_angles, when given, is a pose near which the best path's
// angles are put.
Neighbourhood gather(const MotionDatabase& database, std::vector<Path> paths,
                     Eigen::VectorXd weights, const Eigen::VectorXd* near_angles);

// The poses of the paths that it has already.
void put_poses(const MotionDatabase& database, const Eigen::VectorXd* near_angles,
               Neighbourhood& neighbourhood);

// The clip of each frame, as graphs of paths ask for it.
std::vector<std::int32_t> clips_of_frames(const MotionDatabase& database);

// The clip of a database frame.
const Clip& clip_at(const MotionDatabase& database, int frame);

}  // namespace sparse_mocap::retrieval
