// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/olng.hpp"

namespace sparse_mocap::tautges2011 {

// What the I best paths retrieve from the database (Tautges et al. 2011, section 5): one column or
// entry a path, the best path first.
struct Neighbourhood {
  std::vector<Path> paths;
  Eigen::VectorXd weights;     // W, sum 1, equation (1)
  Eigen::MatrixXd angles;      // Q, 43 x I, rad, each as near to the best path's as it can be put
  Eigen::MatrixXd positions;   // X, 63 x I, m
  Eigen::MatrixXd velocities;  // V, 63 x I, m/s
  Eigen::MatrixXd accelerations;      // A, 63 x I, m/s^2
  Eigen::MatrixXd steps;              // 63 x I, m: from the clip's frame before into this one
  Eigen::MatrixXd velocities_before;  // 63 x I, m/s: at the frame that the path passed before
};

// The num_paths paths of greatest reward, ties by frame.
std::vector<Path> best_paths(std::span<const Path> paths, int num_paths);

// Weights of paths sorted by falling reward: equation (1) with cost = const - reward, or a softmax.
// Equal rewards get equal weights.
Eigen::VectorXd path_weights(std::span<const Path> paths, WeightRule rule, double sharpness);

// Central differences of the positions' rows, inside the frame's clip.
void kinematics_at(const MotionDatabase& database, int frame, Eigen::Ref<Eigen::VectorXd> velocity,
                   Eigen::Ref<Eigen::VectorXd> acceleration);

// Looks the paths up in the database; V, A and velocities_before only if the configuration has use
// for them (empty otherwise). near_angles, when given, is a pose near which the best path's angles
// are put.
Neighbourhood gather(const MotionDatabase& database, const Config& config, std::vector<Path> paths,
                     Eigen::VectorXd weights, const Eigen::VectorXd* near_angles);

}  // namespace sparse_mocap::tautges2011
