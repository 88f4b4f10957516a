// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap::tautges2011 {

// What of a pose a term compares: its angles, the positions of joints' ends (3 rows a joint), or
// how high these are above their parents' ends (a row a joint, m).
enum class Compared { positions, angles, rises };

struct TermSpace {
  Compared compared = Compared::positions;
  std::vector<int> joints;  // of positions and rises; empty: all, of positions only
};

// One kernel sum of the energy: weight * sum_i w_i |y_i - y|^power (equations (5), (7), (8), (11)
// with power 1/2), y the pose's angles (rad) or stacked joint positions (m). Norms are of the whole
// vector.
struct KernelTerm {
  TermSpace space;
  double weight = 1.0;
  double power = 0.5;
  Eigen::MatrixXd targets;  // y_i, one column a path
};

// The energy of equations (2) and (3): a sum of kernel sums that share the paths' weights w_i.
//
// Distances are softened by kSoftening, where the square root's slope is infinite:
// |r| = sqrt(r^2 + kSoftening^2).
class Energy {
 public:
  static constexpr double kSoftening = 1e-3;  // rad or m

  // The skeleton must outlive the energy.
  // The skeleton must outlive the energy.
  Energy(const Skeleton& skeleton, const Eigen::VectorXd& weights, std::vector<KernelTerm> terms);

  double value(const Eigen::VectorXd& angles) const;
  // Also d value / d angles.
  double value_and_gradient(const Eigen::VectorXd& angles, Eigen::VectorXd& gradient) const;

  // The quadratic in the pose that touches the energy at angles and lies above it for every fixed
  // linearisation of the positions: each kernel sum collapses to one weighted mean.
  //   value at the pose, gradient g and matrix H with model(d) = value + g.d + d.H.d / 2,
  // both restricted to the columns of basis (angles = ... + basis * d).
  struct Model {
    double value = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
  };
  Model majorised(const Eigen::VectorXd& angles, const Eigen::MatrixXd& basis) const;

 private:
  // A kernel sum with the weights of its targets and what of it does not depend on the pose.
  struct Sum {
    KernelTerm term;
    Eigen::VectorXd weights;
    double constant = 0.0;
  };
  static Sum prepared(KernelTerm term, const Eigen::VectorXd& weights);

  const Skeleton& skeleton_;
  std::vector<Sum> sums_;
};

}  // namespace sparse_mocap::tautges2011
