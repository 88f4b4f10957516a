// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "sparse_mocap/liu2011/config.hpp"
#include "sparse_mocap/liu2011/map_estimate.hpp"
#include "sparse_mocap/liu2011/motion_examples.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::liu2011 {

// The K closest examples as section 5 learns from them: pose vectors about the mean of the poses
// that follow, one column an example.
struct LocalExamples {
  BodyPose reference;
  Eigen::MatrixXd x;        // m poses one after another, the newest first
  Eigen::MatrixXd y;        // the pose that follows
  Eigen::VectorXd weights;  // equation (6)
};

LocalExamples local_examples(const MotionExamples& examples,
                             std::span<const retrieval::Neighbour> nearest, int num_poses);

// The priors below are told the recent poses, the newest first, in the newest's heading frame.

// Equations (8), (13), (14): one prediction a degree of freedom.
PosePrior dynamic_prior(const Skeleton& body, const LocalExamples& examples,
                        std::span<const BodyPose> recent, const Config& config);

// Chai and Hodgins 2005, sections 5 and 6: poses vary in the principal subspace of the examples and
// move on evenly.
PosePrior local_pca_prior(const Skeleton& body, const LocalExamples& examples,
                          std::span<const BodyPose> recent, const Config& config);

// Inverse kinematics: near the pose before.
PosePrior previous_pose_prior(const Skeleton& body, std::span<const BodyPose> recent,
                              const Config& config);

PosePrior pose_prior(const Skeleton& body, const LocalExamples& examples,
                     std::span<const BodyPose> recent, const Config& config);

}  // namespace sparse_mocap::liu2011
