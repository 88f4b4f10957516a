// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::retrieval {

// The most numbers that a pose has: 43 angles, or 63 coordinates of joints. Of so many at most,
// vectors and matrices change their size from frame to frame without memory of the heap.
inline constexpr int kMostPoseValues = 64;
using PoseVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostPoseValues, 1>;
using PoseMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                 kMostPoseValues, kMostPoseValues>;

// A local linear model of poses (Tautges et al. 2011, section 5.3): pose = mean + basis * y.
struct PoseSubspace {
  PoseVector mean;   // rad
  PoseMatrix basis;  // orthonormal columns, by falling variance

  PoseVector coordinates(const PoseVector& pose) const {
    const PoseVector apart = pose - mean;
    return basis.transpose() * apart;
  }
  PoseVector pose(const PoseVector& coordinates) const { return mean + basis * coordinates; }
};

// Weighted PCA of the columns of poses: as many components as keep the share `variance`, at least
// one. Weights sum to 1.
PoseSubspace weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights,
                          double variance);
void put_weighted_pca(const Eigen::MatrixXd& poses, const Eigen::VectorXd& weights, double variance,
                      PoseSubspace& subspace);

}  // namespace sparse_mocap::retrieval
