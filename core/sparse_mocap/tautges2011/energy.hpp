// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"

namespace sparse_mocap::tautges2011 {

// What of a pose a term compares: its angles (rad), or the positions of joints' ends (m, stacked).
struct TermSpace {
  enum class Compared { angles, positions };

  Compared compared = Compared::positions;
  std::vector<int> joints;  // of positions; empty: all
};

// A kernel sum, equations (5), (7), (8), (11): weight * sum_i w_i sqrt|y_i - y|. Norms are of the
// whole vector.
struct KernelTerm {
  TermSpace space;
  double weight = 1.0;
  Eigen::MatrixXd targets;  // y_i, one column a path; rows beyond those of y are not looked at

  // y_i alone.
  auto compared_targets() const {
    const auto joints = static_cast<Eigen::Index>(space.joints.size());
    return targets.topRows(joints == 0 ? targets.rows() : 3 * joints);
  }
};

// A normal distribution instead (figure 11): weight * |whitening (y - mean)|^2.
struct NormalTerm {
  TermSpace space;
  double weight = 1.0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd whitening;
};

struct EnergyTerms {
  std::vector<KernelTerm> kernels;
  std::vector<NormalTerm> normals;
};

// The energy of equations (2) and (3): a sum of terms that share the paths' weights w_i.
//
// Distances are softened by kSoftening, where the square root's slope is infinite:
// |r| = sqrt(r^2 + kSoftening^2).
class Energy : public retrieval::PoseObjective {
 public:
  static constexpr double kSoftening = 1e-3;  // rad or m

  // The skeleton must outlive the energy. Terms of weight 0 are left out.
  explicit Energy(const Skeleton& skeleton, Eigen::VectorXd weights = {}, EnergyTerms terms = {});

  // To be filled for the next frame, in the memory of the last one.
  Eigen::VectorXd& weights() { return weights_; }
  EnergyTerms& terms() { return terms_; }

  double value(const retrieval::PoseVector& angles) const override;
  // Each kernel sum collapses to one weighted mean.
  Model majorised(const retrieval::PoseVector& angles,
                  const retrieval::PoseMatrix& basis) const override;

  // Also d value / d angles.
  double value_and_gradient(const Eigen::VectorXd& angles, Eigen::VectorXd& gradient) const;

 private:
  const Skeleton& skeleton_;
  Eigen::VectorXd weights_;
  EnergyTerms terms_;
};

}  // namespace sparse_mocap::tautges2011
