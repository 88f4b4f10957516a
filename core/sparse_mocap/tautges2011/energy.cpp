// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy.hpp"

#include <utility>

namespace sparse_mocap::tautges2011 {
namespace {

// What a kernel sum comes to at y, and the mean and stiffness to which it collapses. With
// r_i = |y_i - y| (softened) and p = 1/2, r^p <= r_0^p + p/2 r_0^(p-2) (r^2 - r_0^2), so
// c_i = w_i p r_i^(p-2) gives sum <= value + S/2 (|mean - y'|^2 - |mean - y|^2), S = sum c_i, and
// S (y - mean) is the gradient itself.
struct Collapsed {
  double value = 0.0;
  double stiffness = 0.0;
  Eigen::VectorXd pull;  // S (y - mean)
};

constexpr double kPower = 0.5;

Eigen::ArrayXd softened_squares(const KernelTerm& term, const Eigen::VectorXd& y) {
  return (term.targets.colwise() - y).colwise().squaredNorm().transpose().array() +
         Energy::kSoftening * Energy::kSoftening;
}

double kernel_sum(const KernelTerm& term, const Eigen::VectorXd& weights,
                  const Eigen::ArrayXd& squares) {
  return term.weight * (weights.array() * squares.pow(0.5 * kPower)).sum();
}

Collapsed collapse(const KernelTerm& term, const Eigen::VectorXd& weights,
                   const Eigen::VectorXd& y) {
  const Eigen::ArrayXd squares = softened_squares(term, y);
  Collapsed out;
  out.value = kernel_sum(term, weights, squares);
  const Eigen::VectorXd c =
      term.weight * kPower * weights.array() * squares.pow(0.5 * kPower - 1.0);
  out.stiffness = c.sum();
  out.pull = out.stiffness * y - term.targets * c;
  return out;
}

Eigen::VectorXd observed(const TermSpace& space, const Eigen::VectorXd& angles,
                         const JointTransforms& transforms) {
  if (space.compared == TermSpace::Compared::angles) return angles;
  const auto count = space.joints.empty() ? transforms.end.size() : space.joints.size();
  Eigen::VectorXd y(3 * static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k)
    y.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        transforms.end[space.joints.empty() ? k : static_cast<std::size_t>(space.joints[k])];
  return y;
}

Eigen::MatrixXd observed_jacobian(const TermSpace& space, const Eigen::MatrixXd& positions_by_basis,
                                  const Eigen::MatrixXd& basis) {
  if (space.compared == TermSpace::Compared::angles) return basis;
  if (space.joints.empty()) return positions_by_basis;
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(space.joints.size()), basis.cols());
  for (std::size_t k = 0; k < space.joints.size(); ++k)
    rows.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        positions_by_basis.middleRows(3 * space.joints[k], 3);
  return rows;
}

template <typename Term>
std::vector<Term> without_weightless(std::vector<Term> terms) {
  std::erase_if(terms, [](const Term& term) { return term.weight == 0.0; });
  return terms;
}

}  // namespace

Energy::Energy(const Skeleton& skeleton, Eigen::VectorXd weights, EnergyTerms terms)
    : skeleton_(skeleton),
      weights_(std::move(weights)),
      terms_{without_weightless(std::move(terms.kernels)),
             without_weightless(std::move(terms.normals))} {}

double Energy::value(const Eigen::VectorXd& angles) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  double total = 0.0;
  for (const auto& term : terms_.kernels)
    total += kernel_sum(term, weights_,
                        softened_squares(term, observed(term.space, angles, transforms)));
  for (const auto& term : terms_.normals)
    total +=
        term.weight *
        (term.whitening * (observed(term.space, angles, transforms) - term.mean)).squaredNorm();
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
  for (const auto& term : terms_.kernels) {
    const Collapsed sum = collapse(term, weights_, observed(term.space, angles, transforms));
    model.value += sum.value;
    if (term.space.compared == TermSpace::Compared::positions && term.space.joints.empty()) {
      model.gradient.noalias() += positions_by_basis.transpose() * sum.pull;
      stiffness_of_all_positions += sum.stiffness;
      continue;
    }
    const Eigen::MatrixXd jacobian = observed_jacobian(term.space, positions_by_basis, basis);
    model.gradient.noalias() += jacobian.transpose() * sum.pull;
    hessian.rankUpdate(jacobian.transpose(), sum.stiffness);
  }
  if (stiffness_of_all_positions != 0.0)
    hessian.rankUpdate(positions_by_basis.transpose(), stiffness_of_all_positions);
  for (const auto& term : terms_.normals) {
    const Eigen::VectorXd residual =
        term.whitening * (observed(term.space, angles, transforms) - term.mean);
    const Eigen::MatrixXd jacobian =
        term.whitening * observed_jacobian(term.space, positions_by_basis, basis);
    model.value += term.weight * residual.squaredNorm();
    model.gradient.noalias() += 2.0 * term.weight * jacobian.transpose() * residual;
    hessian.rankUpdate(jacobian.transpose(), 2.0 * term.weight);
  }
  model.hessian.triangularView<Eigen::StrictlyUpper>() = model.hessian.transpose();
  return model;
}

}  // namespace sparse_mocap::tautges2011
