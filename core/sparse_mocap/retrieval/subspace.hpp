// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::retrieval {

// A local linear model of poses (Tautges et al. 2011, section 5.3): pose = mean + basis * y.
struct PoseSubspace {
  Eigen::VectorXd mean;   // rad
  Eigen::MatrixXd basis;  // orthonormal columns, by falling variance

  Eigen::VectorXd coordinates(const Eigen::VectorXd& pose) const {
    return basis.transpose() * (pose - mean);
  }
  Eigen::VectorXd pose(const Eigen::VectorXd& coordinates) const {
    return mean + basis * coordinates;
  }
};

// Weighted PCA of the columns of poses: as many components as keep the share `variance`, at least
// one. Weights sum to 1.
PoseSubspace weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights,
                          double variance);

}  // namespace sparse_mocap::retrieval
