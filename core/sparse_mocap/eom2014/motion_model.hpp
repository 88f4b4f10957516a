// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/eom2014/kernels.hpp"

namespace sparse_mocap::eom2014 {

// Poses and velocities that a motion model is learnt from. Frames are rows.
struct MotionData {
  Eigen::MatrixXd poses;       // frames x channels
  Eigen::MatrixXd velocities;  // steps x channels, per second
  std::vector<int> steps;      // the frames that a step leads to from the frame before

  int num_frames() const { return static_cast<int>(poses.rows()); }
};

// What is learnt: a point of the latent space for each frame, and the kernels' parameters.
struct Latent {
  Eigen::MatrixXd X;  // frames x dimensions
  PoseKernel pose;
  VelocityKernel velocity;

  // The points that the steps lead to, and the steps.
  VelocityKernel::Points steps(const std::vector<int>& steps) const;
};

struct Posterior {
  double value = 0.0;
  Eigen::MatrixXd by_X;
  Eigen::Vector3d by_alpha;
  Eigen::Vector4d by_beta;
};

// Eom et al. 2014, equation 6, of centred poses and velocities without constant channels:
//   L_Y + L_V - sum ln alpha - sum ln beta - 1/2 sum |x|^2,
// W at its best. The last term is Lawrence's prior of the latent points (2005), without which they
// could grow without end while alpha_2, beta_2 and beta_3 shrink.
Posterior log_posterior(const MotionData& centred, const Latent& latent);

// The start: the principal components of the poses, each channel divided by its deviation. The
// first has a deviation of 1.
Latent principal_components(const MotionData& centred, int dimensions);

struct LearningSettings {
  int dimensions = 5;
  int max_iterations = 1500;
};

// A model of full-body motion: latent points that poses and velocities are predicted from.
class MotionModel {
 public:
  // Learns by L-BFGS from the principal components. alpha_1 and beta_1 stay 1: W tells the scale of
  // the channels. Throws ConfigError for fewer than 10 frames, and Cancelled.
  static MotionModel learnt(const MotionData& data, const LearningSettings& settings,
                            const Progress& progress);
  // What was learnt before.
  MotionModel(MotionData data, Latent latent);

  // Equation 7 without its W, which the likelihood puts on poses, not on what is predicted:
  //   y = Y^T K^-1 k(x) + bias.
  Eigen::VectorXd pose(const Eigen::VectorXd& x) const;
  // The same of the velocity process: v = V^T K_V^-1 k_V([x, x_before]) + bias.
  Eigen::VectorXd velocity(const Eigen::VectorXd& x, const Eigen::VectorXd& x_before) const;

  const MotionData& data() const { return data_; }
  const Latent& latent() const { return latent_; }
  double log_posterior() const;

 private:
  MotionData data_;
  Latent latent_;
  Eigen::VectorXd mean_pose_, mean_velocity_;
  VelocityKernel::Points steps_;
  Eigen::MatrixXd pose_coefficients_, velocity_coefficients_;  // K^-1 Y, K_V^-1 V
};

}  // namespace sparse_mocap::eom2014
