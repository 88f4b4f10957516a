// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/map_estimate.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

namespace sparse_mocap::liu2011 {
namespace {

constexpr double kRelativeDecrease = 1e-6;  // below this share of the value, it has converged
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e8;
constexpr double kWider = 20.0;

Vec3 position_residual(const Observation& observed, const SensorPose& predicted) {
  return predicted.position - observed.measured.position;
}

// log(R_predicted R_measured^T), in the frame.
Vec3 orientation_residual(const Observation& observed, const SensorPose& predicted) {
  return logarithm(predicted.R_frame_sensor * observed.measured.R_frame_sensor.transpose());
}

// Adds a robust residual; d residual / d root position is the identity or nothing.
struct ControlTerm {
  Vec3 residual;
  Eigen::Matrix3Xd jacobian;  // by the whole step
};

void add_term(const ControlTerm& term, double sigma, double robustness,
              PosteriorEnergy::Equations& out) {
  const double squared = term.residual.squaredNorm();
  const double scaled = squared / (2.0 * robustness * robustness * sigma * sigma);
  const double weight = 1.0 / ((1.0 + scaled) * sigma * sigma);
  out.value += robust_cost(squared, sigma, robustness);
  out.gradient.noalias() += weight * (term.jacobian.transpose() * term.residual);
  out.hessian.noalias() += weight * (term.jacobian.transpose() * term.jacobian);
}

}  // namespace

double robust_cost(double squared_norm, double sigma, double robustness) {
  const double c2 = robustness * robustness;
  return c2 * std::log1p(squared_norm / (2.0 * c2 * sigma * sigma));
}

double PosteriorEnergy::control(const BodyPose& pose) const {
  JointTransforms transforms;
  forward_kinematics(body_, pose, transforms);
  double sum = 0.0;
  for (const Observation& observed : observed_) {
    const SensorPose predicted = sensor_pose(observed.worn, transforms);
    if (observed.has_position)
      sum +=
          robust_cost(position_residual(observed, predicted).squaredNorm(),
                      observed.position_looseness * weights_.sigma_position_m, weights_.robustness);
    if (observed.has_orientation)
      sum += robust_cost(orientation_residual(observed, predicted).squaredNorm(),
                         weights_.sigma_orientation_rad, weights_.robustness);
  }
  return sum;
}

double PosteriorEnergy::value(const BodyPose& pose) const {
  const Eigen::VectorXd q = pose_vector(body_, prior_.reference, pose);
  return control(pose) + 0.5 * (prior_.whitening * q - prior_.target).squaredNorm();
}

PosteriorEnergy::Equations PosteriorEnergy::equations(const BodyPose& pose) const {
  const Eigen::Index n = num_freedoms(body_);
  Equations out{0.0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  add_control(pose, out);
  add_prior(pose, out);
  return out;
}

void PosteriorEnergy::add_control(const BodyPose& pose, Equations& out) const {
  if (observed_.empty()) return;
  JointTransforms transforms;
  forward_kinematics(body_, pose, transforms);
  const StepJacobians steps = step_jacobians(body_, pose.rotations, transforms);
  const Eigen::Index angles = body_.num_angles();
  for (const Observation& observed : observed_) {
    const SensorPose predicted = sensor_pose(observed.worn, transforms);
    ControlTerm term{Vec3::Zero(), Eigen::Matrix3Xd::Zero(3, 3 + angles)};
    if (observed.has_position) {
      const Eigen::Index row = 3 * observed.worn.carrier;
      const Vec3 arm =
          predicted.position - transforms.end[static_cast<std::size_t>(observed.worn.carrier)];
      term.residual = position_residual(observed, predicted);
      term.jacobian.leftCols<3>().setIdentity();
      term.jacobian.rightCols(angles) = steps.ends.middleRows<3>(row);
      for (Eigen::Index a = 0; a < angles; ++a)
        term.jacobian.col(3 + a) += Vec3(steps.turns.block<3, 1>(row, a)).cross(arm);
      add_term(term, observed.position_looseness * weights_.sigma_position_m, weights_.robustness,
               out);
    }
    if (observed.has_orientation) {
      term.residual = orientation_residual(observed, predicted);
      term.jacobian.leftCols<3>().setZero();
      term.jacobian.rightCols(angles) = left_jacobian_inverse(term.residual) *
                                        steps.turns.middleRows<3>(3 * observed.worn.turning);
      add_term(term, weights_.sigma_orientation_rad, weights_.robustness, out);
    }
  }
}

void PosteriorEnergy::add_prior(const BodyPose& pose, Equations& out) const {
  const Eigen::VectorXd q = pose_vector(body_, prior_.reference, pose);
  const Eigen::VectorXd residual = prior_.whitening * q - prior_.target;
  const Eigen::MatrixXd jacobian = prior_.whitening * pose_vector_jacobian(body_, q);
  out.value += 0.5 * residual.squaredNorm();
  out.gradient.noalias() += jacobian.transpose() * residual;
  out.hessian.noalias() += jacobian.transpose() * jacobian;
}

Estimate nearest_minimum(const Skeleton& body, const PosteriorEnergy& energy, BodyPose start,
                         int max_iterations) {
  Estimate best{std::move(start), 0.0, 0};
  auto equations = energy.equations(best.pose);
  best.value = equations.value;
  double damping = kFirstDamping;
  while (best.iterations < max_iterations && damping < kMostDamping) {
    ++best.iterations;
    Eigen::MatrixXd damped = equations.hessian;
    damped.diagonal() += damping * equations.hessian.diagonal();
    damped.diagonal().array() += 1e-9;
    const Eigen::VectorXd step = -damped.ldlt().solve(equations.gradient);
    BodyPose next = moved(body, best.pose, step);
    const double value = energy.value(next);
    if (!(value < best.value)) {
      damping *= 10.0;
      continue;
    }
    const bool is_converged = best.value - value <= kRelativeDecrease * best.value;
    best.pose = std::move(next);
    best.value = value;
    damping *= 0.1;
    if (is_converged) break;
    equations = energy.equations(best.pose);
  }
  return best;
}

bool is_off_track(std::span<const Observation> observed, const ControlWeights& weights,
                  double control) {
  double usual = 0.0;
  for (const Observation& one : observed)
    usual += ((one.has_position ? 1.0 : 0.0) + (one.has_orientation ? 1.0 : 0.0)) *
             robust_cost(weights.robustness * weights.robustness, 1.0, weights.robustness);
  return control > usual;
}

Estimate map_estimate(const Skeleton& body, std::span<const Observation> observed,
                      const ControlWeights& weights, const PosePrior& prior, const BodyPose& start,
                      int max_iterations) {
  const PosteriorEnergy energy(body, observed, weights, prior);
  Estimate near = nearest_minimum(body, energy, start, max_iterations);
  if (!is_off_track(observed, weights, energy.control(near.pose))) return near;
  ControlWeights wide = weights;
  wide.robustness *= kWider;
  const PosteriorEnergy wide_energy(body, observed, wide, prior);
  BodyPose led = nearest_minimum(body, wide_energy, start, max_iterations).pose;
  Estimate other = nearest_minimum(body, energy, std::move(led), max_iterations);
  return other.value < near.value ? other : near;
}

}  // namespace sparse_mocap::liu2011
