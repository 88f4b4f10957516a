// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/pose_priors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sparse_mocap/liu2011/local_dynamic_model.hpp"

namespace sparse_mocap::liu2011 {
namespace {

constexpr double kRootPerAngle_m = 0.5;  // metres of the root that count as a radian

// The least deviation of each freedom: of the root's position and of angles.
Eigen::VectorXd floors(Eigen::Index freedoms, double root_m, double angle_deg) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(freedoms, angle_deg * kRadiansPerDegree);
  out.head<3>().setConstant(root_m);
  return out;
}

// Equation (14): one row a degree of freedom.
Eigen::MatrixXd own_whitening(const Eigen::VectorXd& deviations, const Eigen::VectorXd& least) {
  return Eigen::MatrixXd(deviations.cwiseMax(least).cwiseInverse().asDiagonal());
}

// The same with the covariance of all residuals, to which the floors are added.
Eigen::MatrixXd joint_whitening(const Eigen::MatrixXd& residuals, const Eigen::VectorXd& least) {
  Eigen::MatrixXd covariance = residuals * residuals.transpose();
  covariance.diagonal() += least.cwiseAbs2();
  return covariance.llt().matrixL().solve(Eigen::MatrixXd::Identity(least.size(), least.size()));
}

}  // namespace

LocalExamples local_examples(const MotionExamples& examples,
                             std::span<const retrieval::Neighbour> nearest, int num_poses) {
  const auto count = static_cast<Eigen::Index>(nearest.size());
  LocalExamples out;
  Eigen::VectorXd distances(count);
  std::vector<int> frames;
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto& neighbour = nearest[static_cast<std::size_t>(k)];
    distances[k] = static_cast<double>(neighbour.distance);
    frames.push_back(neighbour.row);
  }
  out.weights = example_weights(distances);
  out.reference = examples.mean_next(frames, out.weights);
  const auto reference = examples.reference(out.reference);
  out.x.resize(num_poses * num_freedoms(examples.body()), count);
  out.y.resize(num_freedoms(examples.body()), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int frame = frames[static_cast<std::size_t>(k)];
    out.x.col(k) = examples.vectors(examples.history(frame, num_poses), reference);
    examples.put_vector({frame, examples.step(frame)}, reference, out.y.col(k).data());
  }
  return out;
}

PosePrior dynamic_prior(const Skeleton& body, const LocalExamples& examples,
                        std::span<const BodyPose> recent, const Config& config) {
  const LocalDynamicModel model = local_dynamic_model(examples.x, examples.y, examples.weights,
                                                      config.pca_variance, config.history_trust);
  const Eigen::VectorXd least =
      floors(examples.y.rows(), config.root_deviation_floor_m, config.deviation_floor_deg);
  const Eigen::VectorXd predicted = model.predicted(pose_vectors(body, examples.reference, recent));
  const Eigen::MatrixXd whitening = config.joint_residuals ? joint_whitening(model.residuals, least)
                                                           : own_whitening(model.deviations, least);
  return {examples.reference, whitening, whitening * predicted};
}

PosePrior local_pca_prior(const Skeleton& body, const LocalExamples& examples,
                          std::span<const BodyPose> recent, const Config& config) {
  const Eigen::Index n = examples.y.rows();
  const Eigen::VectorXd share = examples.weights / examples.weights.sum();
  const Eigen::VectorXd mean = examples.y * share;
  const Eigen::MatrixXd centred = (examples.y.colwise() - mean) * share.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(centred * centred.transpose());
  // Directions beyond the subspace are held at the floor.
  const double floor_rad = config.deviation_floor_deg * kRadiansPerDegree;
  Eigen::VectorXd deviations = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  double beyond = (1.0 - config.local_pca_variance) * eigen.eigenvalues().sum();
  for (Eigen::Index i = 0; i < n; ++i) {  // Eigen sorts ascending
    beyond -= eigen.eigenvalues()[i];
    deviations[i] = beyond >= 0.0 ? floor_rad : std::max(deviations[i], floor_rad);
  }
  Eigen::VectorXd even =
      floors(n, kRootPerAngle_m * config.smoothness_deg * kRadiansPerDegree, config.smoothness_deg)
          .cwiseInverse();
  const Eigen::VectorXd moving_on = 2.0 * pose_vector(body, examples.reference, recent[0]) -
                                    pose_vector(body, examples.reference, recent[1]);
  PosePrior prior{examples.reference, Eigen::MatrixXd(2 * n, n), Eigen::VectorXd(2 * n)};
  prior.whitening << deviations.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose(),
      Eigen::MatrixXd(even.asDiagonal());
  prior.target << prior.whitening.topRows(n) * mean, even.cwiseProduct(moving_on);
  return prior;
}

PosePrior previous_pose_prior(const Skeleton& body, std::span<const BodyPose> recent,
                              const Config& config) {
  const Eigen::Index n = num_freedoms(body);
  const double root_m = kRootPerAngle_m * config.ik_deviation_deg * kRadiansPerDegree;
  return {recent[0], floors(n, root_m, config.ik_deviation_deg).cwiseInverse().asDiagonal(),
          Eigen::VectorXd::Zero(n)};
}

PosePrior pose_prior(const Skeleton& body, const LocalExamples& examples,
                     std::span<const BodyPose> recent, const Config& config) {
  switch (config.prior) {
    case PriorModel::local_pca:
      return local_pca_prior(body, examples, recent, config);
    case PriorModel::inverse_kinematics:
      return previous_pose_prior(body, recent, config);
    case PriorModel::dynamic:
      break;
  }
  return dynamic_prior(body, examples, recent, config);
}

}  // namespace sparse_mocap::liu2011
