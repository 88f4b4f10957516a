// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace sparse_mocap::eom2014 {

// The two kernels of Eom et al. 2014. Points are rows.

// Of poses (equation 1): k(x_i, x_j) = a1 exp(-a2/2 |x_i - x_j|^2) + a3 delta_ij.
struct PoseKernel {
  Eigen::Vector3d alpha{1.0, 1.0, 0.01};

  // Between different points, without the noise a3.
  Eigen::MatrixXd between(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const;
  // Of the points with themselves, noise included.
  Eigen::MatrixXd matrix(const Eigen::MatrixXd& X) const;

  struct Gradient {
    Eigen::Vector3d alpha;
    Eigen::MatrixXd X;
  };
  // From d value / d matrix(X), which is symmetric, to that by what the matrix is made of.
  Gradient pulled_back(const Eigen::MatrixXd& X, const Eigen::MatrixXd& by_kernel) const;
};

// Of velocities (equation 3), between a point with the step that led to it and another:
//   k = b1 v_i^T v_j exp(-b2/2 |v_i - v_j|^2 - b3/2 |x_i - x_j|^2) + b4 delta_ij.
struct VelocityKernel {
  Eigen::Vector4d beta{1.0, 1.0, 1.0, 0.01};

  struct Points {
    Eigen::MatrixXd X;  // where the steps end
    Eigen::MatrixXd V;  // the steps
  };

  Eigen::MatrixXd between(const Points& a, const Points& b) const;
  Eigen::MatrixXd matrix(const Points& points) const;

  struct Gradient {
    Eigen::Vector4d beta;
    Eigen::MatrixXd X, V;
  };
  Gradient pulled_back(const Points& points, const Eigen::MatrixXd& by_kernel) const;
};

}  // namespace sparse_mocap::eom2014
