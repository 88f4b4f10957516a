// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy.hpp"

#include <utility>

namespace sparse_mocap::tautges2011 {
namespace {

// What a kernel sum comes to at y, and the mean and stiffness to which it collapses. With
// r_i = |y_i - y| (softened), r^p <= r_0^p + p/2 r_0^(p-2) (r^2 - r_0^2) for p <= 2, so
// c_i = w_i p r_i^(p-2) gives sum <= value + S/2 (|mean - y'|^2 - |mean - y|^2), S = sum c_i, and
// S (y - mean) is the gradient itself.
struct Collapsed {
  double value = 0.0;
  double stiffness = 0.0;
  Eigen::VectorXd pull;  // S (y - mean)
};

Eigen::ArrayXd softened_squares(const KernelTerm& term, const Eigen::VectorXd& y) {
  return (term.targets.colwise() - y).colwise().squaredNorm().transpose().array() +
         Energy::kSoftening * Energy::kSoftening;
}

double kernel_sum(const KernelTerm& term, const Eigen::VectorXd& weights,
                  const Eigen::ArrayXd& squares) {
  return term.weight * (weights.array() * squares.pow(0.5 * term.power)).sum();
}

Collapsed collapse(const KernelTerm& term, const Eigen::VectorXd& weights,
                   const Eigen::VectorXd& y) {
  const Eigen::ArrayXd squares = softened_squares(term, y);
  const double p = term.power;
  Collapsed out;
  out.value = kernel_sum(term, weights, squares);
  const Eigen::VectorXd c = term.weight * p * weights.array() * squares.pow(0.5 * p - 1.0);
  out.stiffness = c.sum();
  out.pull = out.stiffness * y - term.targets * c;
  return out;
}

Eigen::VectorXd observed(const Skeleton& skeleton, const TermSpace& space,
                         const Eigen::VectorXd& angles, const JointTransforms& transforms) {
  if (space.compared == Compared::angles) return angles;
  if (space.compared == Compared::rises) {
    Eigen::VectorXd rises(static_cast<Eigen::Index>(space.joints.size()));
    for (Eigen::Index k = 0; k < rises.size(); ++k) {
      const int joint = space.joints[static_cast<std::size_t>(k)];
      const int parent = skeleton.joint(joint).parent;
      rises[k] = kUp.dot(transforms.end[static_cast<std::size_t>(joint)] -
                         transforms.end[static_cast<std::size_t>(parent)]);
    }
    return rises;
  }
  const auto count = space.joints.empty() ? transforms.end.size() : space.joints.size();
  Eigen::VectorXd y(3 * static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k)
    y.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        transforms.end[space.joints.empty() ? k : static_cast<std::size_t>(space.joints[k])];
  return y;
}

Eigen::MatrixXd observed_jacobian(const Skeleton& skeleton, const TermSpace& space,
                                  const Eigen::MatrixXd& positions_by_basis,
                                  const Eigen::MatrixXd& basis) {
  if (space.compared == Compared::angles) return basis;
  if (space.compared == Compared::rises) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(space.joints.size()), basis.cols());
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      const int joint = space.joints[static_cast<std::size_t>(k)];
      const int parent = skeleton.joint(joint).parent;
      rows.row(k) = kUp.transpose() * (positions_by_basis.middleRows(3 * joint, 3) -
                                       positions_by_basis.middleRows(3 * parent, 3));
    }
    return rows;
  }
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(space.joints.size()), basis.cols());
  for (std::size_t k = 0; k < space.joints.size(); ++k)
    rows.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        positions_by_basis.middleRows(3 * space.joints[k], 3);
  return rows;
}

}  // namespace

// Squared distances to many targets are those to their mean and a constant.
Energy::Sum Energy::prepared(KernelTerm term, const Eigen::VectorXd& weights) {
  if (term.power != 2.0) return {std::move(term), weights};
  const double total = weights.sum();
  const Eigen::VectorXd mean = term.targets * weights / total;
  const Eigen::VectorXd spread =
      (term.targets.colwise() - mean).colwise().squaredNorm().transpose();
  const double constant = term.weight * spread.dot(weights);
  term.targets = mean;
  return {std::move(term), Eigen::VectorXd::Constant(1, total), constant};
}

Energy::Energy(const Skeleton& skeleton, const Eigen::VectorXd& weights,
               std::vector<KernelTerm> terms)
    : skeleton_(skeleton) {
  for (auto& term : terms)
    if (term.weight != 0.0) sums_.push_back(prepared(std::move(term), weights));
}

double Energy::value(const Eigen::VectorXd& angles) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  double total = 0.0;
  for (const auto& [term, weights, constant] : sums_)
    total += constant + kernel_sum(term, weights,
                                   softened_squares(
                                       term, observed(skeleton_, term.space, angles, transforms)));
  return total;
}

double Energy::value_and_gradient(const Eigen::VectorXd& angles, Eigen::VectorXd& gradient) const {
  const Model model = majorised(angles, Eigen::MatrixXd::Identity(angles.size(), angles.size()));
  gradient = model.gradient;
  return model.value;
}

Energy::Model Energy::majorised(const Eigen::VectorXd& angles, const Eigen::MatrixXd& basis) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  const Eigen::MatrixXd positions_by_basis =
      position_jacobian(skeleton_, angles, transforms) * basis;
  const auto n = basis.cols();
  Model model{0.0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  auto hessian = model.hessian.selfadjointView<Eigen::Lower>();
  double stiffness_of_all_positions = 0.0;
  for (const auto& [term, weights, constant] : sums_) {
    const Collapsed sum =
        collapse(term, weights, observed(skeleton_, term.space, angles, transforms));
    model.value += constant + sum.value;
    if (term.space.compared == Compared::positions && term.space.joints.empty()) {
      model.gradient.noalias() += positions_by_basis.transpose() * sum.pull;
      stiffness_of_all_positions += sum.stiffness;
      continue;
    }
    const Eigen::MatrixXd jacobian =
        observed_jacobian(skeleton_, term.space, positions_by_basis, basis);
    model.gradient.noalias() += jacobian.transpose() * sum.pull;
    hessian.rankUpdate(jacobian.transpose(), sum.stiffness);
  }
  if (stiffness_of_all_positions != 0.0)
    hessian.rankUpdate(positions_by_basis.transpose(), stiffness_of_all_positions);
  model.hessian.triangularView<Eigen::StrictlyUpper>() = model.hessian.transpose();
  return model;
}

}  // namespace sparse_mocap::tautges2011
