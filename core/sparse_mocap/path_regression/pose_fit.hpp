// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::path_regression {

// Where all joints' ends should be (63, m, heading frame): weight * sum_i w_i |targets_i - y|^2.
struct PositionTarget {
  double weight = 1.0;
  Eigen::VectorXd mean;   // of the targets
  double variance = 0.0;  // weighted mean of |targets_i - mean|^2, m^2
};

// weights sum to 1.
PositionTarget position_target(double weight, const Eigen::MatrixXd& targets,
                               const Eigen::VectorXd& weights);

// How high limbs' ends should be above their beginnings: weight * |rises - y|^2.
struct InclinationTarget {
  double weight = 1.0;
  std::vector<int> joints;
  Eigen::VectorXd rises_m;
};

// What gravity directions say of the limbs that carry the sensors. Sensors without one, and those
// on trunk and head, take no part.
InclinationTarget inclination_target(double weight, const Skeleton& skeleton,
                                     const Reading& reading,
                                     std::span<const retrieval::Signal> signals);

// Inverse kinematics: squared distances to targets. Each model is the Gauss-Newton one.
class PoseFit : public retrieval::PoseObjective {
 public:
  // The skeleton must outlive the fit.
  PoseFit(const Skeleton& skeleton, std::vector<PositionTarget> positions,
          InclinationTarget inclination);

  double value(const Eigen::VectorXd& angles) const override;
  Model majorised(const Eigen::VectorXd& angles, const Eigen::MatrixXd& basis) const override;

 private:
  Eigen::VectorXd rise_residuals(const JointTransforms& transforms) const;

  const Skeleton& skeleton_;
  std::vector<PositionTarget> positions_;
  InclinationTarget inclination_;
};

}  // namespace sparse_mocap::path_regression
