// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/motion_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/eom2014/gaussian_process.hpp"
#include "sparse_mocap/eom2014/minimisation.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr int kFewestFrames = 10;
constexpr double kConstantDeviation = 1e-6;  // of a channel, rad or m, and per second
constexpr double kTolerance = 1e-7;          // of the posterior, from one iteration to the next

// The columns that vary, centred.
Eigen::MatrixXd varying(const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  const Eigen::ArrayXd deviations =
      (centred.colwise().squaredNorm() / static_cast<double>(values.rows())).array().sqrt();
  Eigen::MatrixXd out(values.rows(), (deviations > kConstantDeviation).count());
  for (Eigen::Index c = 0, to = 0; c < values.cols(); ++c)
    if (deviations[c] > kConstantDeviation) out.col(to++) = centred.col(c);
  return out;
}

MotionData centred(const MotionData& data) {
  return {varying(data.poses), varying(data.velocities), data.steps};
}

// The parameters of the optimisation: the latent points, and the logarithms of alpha_2, alpha_3,
// beta_2, beta_3, beta_4.
Eigen::VectorXd packed(const Eigen::MatrixXd& X, const Eigen::Vector3d& alpha,
                       const Eigen::Vector4d& beta) {
  Eigen::VectorXd out(X.size() + 5);
  out << X.reshaped(), alpha.tail<2>(), beta.tail<3>();
  return out;
}

Latent unpacked(const Eigen::VectorXd& parameters, int num_frames) {
  const Eigen::Index size = parameters.size() - 5;
  Latent latent;
  latent.X = parameters.head(size).reshaped(num_frames, size / num_frames);
  const Eigen::VectorXd kernels = parameters.tail(5).array().exp();
  latent.pose.alpha << 1.0, kernels.head<2>();
  latent.velocity.beta << 1.0, kernels.tail<3>();
  return latent;
}

}  // namespace

VelocityKernel::Points Latent::steps(const std::vector<int>& to) const {
  VelocityKernel::Points points;
  points.X.resize(static_cast<Eigen::Index>(to.size()), X.cols());
  points.V.resize(points.X.rows(), X.cols());
  for (Eigen::Index row = 0; row < points.X.rows(); ++row) {
    const int frame = to[static_cast<std::size_t>(row)];
    points.X.row(row) = X.row(frame);
    points.V.row(row) = X.row(frame) - X.row(frame - 1);
  }
  return points;
}

Posterior log_posterior(const MotionData& data, const Latent& latent) {
  const auto of_poses = scaled_likelihood(latent.pose.matrix(latent.X), data.poses);
  const auto steps = latent.steps(data.steps);
  const auto of_steps = scaled_likelihood(latent.velocity.matrix(steps), data.velocities);
  Posterior out;
  out.value = of_poses.value + of_steps.value - latent.pose.alpha.array().log().sum() -
              latent.velocity.beta.array().log().sum() - 0.5 * latent.X.squaredNorm();
  if (!std::isfinite(out.value)) {
    out.value = -std::numeric_limits<double>::infinity();
    return out;
  }
  const auto by_pose = latent.pose.pulled_back(latent.X, of_poses.by_kernel);
  const auto by_step = latent.velocity.pulled_back(steps, of_steps.by_kernel);
  out.by_alpha = by_pose.alpha - latent.pose.alpha.cwiseInverse();
  out.by_beta = by_step.beta - latent.velocity.beta.cwiseInverse();
  out.by_X = by_pose.X - latent.X;
  for (Eigen::Index row = 0; row < steps.X.rows(); ++row) {
    const int frame = data.steps[static_cast<std::size_t>(row)];
    out.by_X.row(frame) += by_step.X.row(row) + by_step.V.row(row);
    out.by_X.row(frame - 1) -= by_step.V.row(row);
  }
  return out;
}

Latent principal_components(const MotionData& data, int dimensions) {
  const auto num_frames = static_cast<double>(data.num_frames());
  const Eigen::VectorXd deviations =
      (data.poses.colwise().squaredNorm().transpose() / num_frames).cwiseSqrt();
  const Eigen::MatrixXd scaled = data.poses * deviations.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(scaled.transpose() * scaled /
                                                             num_frames);
  const Eigen::Index num_parts = std::min<Eigen::Index>(dimensions, scaled.cols());
  const double largest = std::sqrt(parts.eigenvalues()[scaled.cols() - 1]);
  Latent latent;
  latent.X = Eigen::MatrixXd::Zero(data.num_frames(), dimensions);
  for (Eigen::Index d = 0; d < num_parts; ++d)
    latent.X.col(d) = scaled * parts.eigenvectors().col(scaled.cols() - 1 - d) / largest;
  const auto steps = latent.steps(data.steps);
  const double step = steps.V.squaredNorm() / static_cast<double>(steps.V.rows());
  latent.velocity.beta[3] = 0.1 * step;
  return latent;
}

MotionModel MotionModel::learnt(const MotionData& data, const LearningSettings& settings,
                                const Progress& progress) {
  if (data.num_frames() < kFewestFrames || data.steps.empty())
    throw ConfigError("a motion model needs at least " + std::to_string(kFewestFrames) +
                      " frames, got " + std::to_string(data.num_frames()));
  const MotionData used = centred(data);
  if (used.poses.cols() == 0 || used.velocities.cols() == 0)
    throw ConfigError("nothing moves in the clips, so there is nothing to learn");
  const Function cost = [&](const Eigen::VectorXd& at, Eigen::VectorXd* gradient) {
    const Latent latent = unpacked(at, used.num_frames());
    const Posterior posterior = eom2014::log_posterior(used, latent);
    if (gradient != nullptr && std::isfinite(posterior.value))
      *gradient = -packed(posterior.by_X, posterior.by_alpha.cwiseProduct(latent.pose.alpha),
                          posterior.by_beta.cwiseProduct(latent.velocity.beta));
    return -posterior.value;
  };
  const Latent start = principal_components(used, settings.dimensions);
  const Eigen::VectorXd found =
      minimum(cost,
              packed(start.X, start.pose.alpha.array().log().matrix(),
                     start.velocity.beta.array().log().matrix()),
              settings.max_iterations, kTolerance, progress, "learning the motion");
  return {data, unpacked(found, used.num_frames())};
}

MotionModel::MotionModel(MotionData data, Latent latent)
    : data_(std::move(data)), latent_(std::move(latent)) {
  mean_pose_ = data_.poses.colwise().mean();
  mean_velocity_ = data_.velocities.colwise().mean();
  steps_ = latent_.steps(data_.steps);
  const auto coefficients = [](const Eigen::MatrixXd& K, const Eigen::MatrixXd& values,
                               const Eigen::VectorXd& mean) -> Eigen::MatrixXd {
    return Eigen::LDLT<Eigen::MatrixXd>(K).solve(values.rowwise() - mean.transpose());
  };
  pose_coefficients_ = coefficients(latent_.pose.matrix(latent_.X), data_.poses, mean_pose_);
  velocity_coefficients_ =
      coefficients(latent_.velocity.matrix(steps_), data_.velocities, mean_velocity_);
}

Eigen::VectorXd MotionModel::pose(const Eigen::VectorXd& x) const {
  return pose_coefficients_.transpose() * latent_.pose.between(latent_.X, x.transpose()) +
         mean_pose_;
}

Eigen::VectorXd MotionModel::velocity(const Eigen::VectorXd& x,
                                      const Eigen::VectorXd& x_before) const {
  const VelocityKernel::Points at{x.transpose(), (x - x_before).transpose()};
  return velocity_coefficients_.transpose() * latent_.velocity.between(steps_, at) + mean_velocity_;
}

double MotionModel::log_posterior() const {
  return eom2014::log_posterior(centred(data_), latent_).value;
}

}  // namespace sparse_mocap::eom2014
