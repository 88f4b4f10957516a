// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy.hpp"

#include <utility>

#include "sparse_mocap/motion/position_jacobian.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using retrieval::PoseMatrix;
using retrieval::PoseVector;

// What a kernel sum comes to at y, and the mean and stiffness to which it collapses. With
// r_i = |y_i - y| (softened) and p = 1/2, r^p <= r_0^p + p/2 r_0^(p-2) (r^2 - r_0^2), so
// c_i = w_i p r_i^(p-2) gives sum <= value + S/2 (|mean - y'|^2 - |mean - y|^2), S = sum c_i, and
// S (y - mean) is the gradient itself.
struct Collapsed {
  double value = 0.0;
  double stiffness = 0.0;
  PoseVector pull;  // S (y - mean)
};

constexpr double kPower = 0.5;

// A pose and where its joints are, in memory that is used again and again.
struct Posed {
  Eigen::VectorXd angles;
  JointTransforms transforms;
};

const Posed& posed(const Skeleton& skeleton, const PoseVector& angles) {
  static thread_local Posed pose;
  pose.angles = angles;
  forward_kinematics(skeleton, Vec3::Zero(), pose.angles, pose.transforms);
  return pose;
}

// Of the targets from y, one a path.
const Eigen::ArrayXd& softened_squares(const KernelTerm& term, const PoseVector& y) {
  static thread_local Eigen::ArrayXd squares;
  squares = (term.compared_targets().colwise() - y).colwise().squaredNorm().transpose().array() +
            Energy::kSoftening * Energy::kSoftening;
  return squares;
}

double kernel_sum(const KernelTerm& term, const Eigen::VectorXd& weights,
                  const Eigen::ArrayXd& squares) {
  return term.weight * (weights.array() * squares.pow(0.5 * kPower)).sum();
}

Collapsed collapse(const KernelTerm& term, const Eigen::VectorXd& weights, const PoseVector& y) {
  static thread_local Eigen::VectorXd c;
  const Eigen::ArrayXd& squares = softened_squares(term, y);
  Collapsed out;
  out.value = kernel_sum(term, weights, squares);
  c = term.weight * kPower * weights.array() * squares.pow(0.5 * kPower - 1.0);
  out.stiffness = c.sum();
  out.pull = out.stiffness * y;
  out.pull.noalias() -= term.compared_targets() * c;
  return out;
}

PoseVector observed(const TermSpace& space, const Posed& pose) {
  if (space.compared == TermSpace::Compared::angles) return pose.angles;
  const auto& ends = pose.transforms.end;
  const auto count = space.joints.empty() ? ends.size() : space.joints.size();
  PoseVector y(3 * static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k)
    y.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        ends[space.joints.empty() ? k : static_cast<std::size_t>(space.joints[k])];
  return y;
}

PoseMatrix observed_jacobian(const TermSpace& space, const PoseMatrix& positions_by_basis,
                             const PoseMatrix& basis) {
  if (space.compared == TermSpace::Compared::angles) return basis;
  if (space.joints.empty()) return positions_by_basis;
  PoseMatrix rows(3 * static_cast<Eigen::Index>(space.joints.size()), basis.cols());
  for (std::size_t k = 0; k < space.joints.size(); ++k)
    rows.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        positions_by_basis.middleRows(3 * space.joints[k], 3);
  return rows;
}

PoseMatrix positions_by(const Skeleton& skeleton, const Posed& pose, const PoseMatrix& basis) {
  static thread_local Eigen::MatrixXd by_angles;
  put_position_jacobian(skeleton, pose.angles, pose.transforms, by_angles);
  return by_angles * basis;
}

PoseVector residual_of(const NormalTerm& term, const Posed& pose) {
  const PoseVector apart = observed(term.space, pose) - term.mean;
  return term.whitening * apart;
}

}  // namespace

Energy::Energy(const Skeleton& skeleton, Eigen::VectorXd weights, EnergyTerms terms)
    : skeleton_(skeleton), weights_(std::move(weights)), terms_(std::move(terms)) {}

double Energy::value(const PoseVector& angles) const {
  const Posed& pose = posed(skeleton_, angles);
  double total = 0.0;
  for (const auto& term : terms_.kernels)
    if (term.weight != 0.0)
      total += kernel_sum(term, weights_, softened_squares(term, observed(term.space, pose)));
  for (const auto& term : terms_.normals)
    if (term.weight != 0.0) total += term.weight * residual_of(term, pose).squaredNorm();
  return total;
}

double Energy::value_and_gradient(const Eigen::VectorXd& angles, Eigen::VectorXd& gradient) const {
  const Model model = majorised(angles, PoseMatrix::Identity(angles.size(), angles.size()));
  gradient = model.gradient;
  return model.value;
}

Energy::Model Energy::majorised(const PoseVector& angles, const PoseMatrix& basis) const {
  const Posed& pose = posed(skeleton_, angles);
  const PoseMatrix positions_by_basis = positions_by(skeleton_, pose, basis);
  const auto n = basis.cols();
  Model model{0.0, PoseVector::Zero(n), PoseMatrix::Zero(n, n)};
  auto hessian = model.hessian.selfadjointView<Eigen::Lower>();
  double stiffness_of_all_positions = 0.0;
  for (const auto& term : terms_.kernels) {
    if (term.weight == 0.0) continue;
    const Collapsed sum = collapse(term, weights_, observed(term.space, pose));
    model.value += sum.value;
    if (term.space.compared == TermSpace::Compared::positions && term.space.joints.empty()) {
      model.gradient.noalias() += positions_by_basis.transpose() * sum.pull;
      stiffness_of_all_positions += sum.stiffness;
      continue;
    }
    const PoseMatrix jacobian = observed_jacobian(term.space, positions_by_basis, basis);
    model.gradient.noalias() += jacobian.transpose() * sum.pull;
    hessian.rankUpdate(jacobian.transpose(), sum.stiffness);
  }
  if (stiffness_of_all_positions != 0.0)
    hessian.rankUpdate(positions_by_basis.transpose(), stiffness_of_all_positions);
  for (const auto& term : terms_.normals) {
    if (term.weight == 0.0) continue;
    const PoseVector residual = residual_of(term, pose);
    const PoseMatrix jacobian =
        term.whitening * observed_jacobian(term.space, positions_by_basis, basis);
    model.value += term.weight * residual.squaredNorm();
    model.gradient.noalias() += 2.0 * term.weight * jacobian.transpose() * residual;
    hessian.rankUpdate(jacobian.transpose(), 2.0 * term.weight);
  }
  model.hessian.triangularView<Eigen::StrictlyUpper>() = model.hessian.transpose();
  return model;
}

}  // namespace sparse_mocap::tautges2011
