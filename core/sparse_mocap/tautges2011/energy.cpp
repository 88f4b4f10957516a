// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy.hpp"

#include <cmath>
#include <utility>

namespace sparse_mocap::tautges2011 {

// A kernel sum at y: its value, and the mean and stiffness to which it collapses. With
// r_i = |y_i - y| (softened), r^p <= r_0^p + p/2 r_0^(p-2) (r^2 - r_0^2) for p <= 2, so
// c_i = w_i p r_i^(p-2) gives sum <= value + S/2 (|mean - y'|^2 - |mean - y|^2), S = sum c_i, and
// S (y - mean) is the gradient itself.
struct Energy::Collapsed {
  double value = 0.0;
  double stiffness = 0.0;
  Eigen::VectorXd pull;  // S (y - mean)
};

Energy::Energy(const Skeleton& skeleton, Eigen::VectorXd weights, std::vector<KernelTerm> terms)
    : skeleton_(skeleton), weights_(std::move(weights)), terms_(std::move(terms)) {
  std::erase_if(terms_, [](const KernelTerm& term) { return term.weight == 0.0; });
}

Energy::Collapsed Energy::collapse(const KernelTerm& term, const Eigen::VectorXd& y) const {
  const Eigen::ArrayXd squared =
      (term.targets.colwise() - y).colwise().squaredNorm().transpose().array() +
      kSoftening * kSoftening;
  const double p = term.power;
  Collapsed out;
  out.value = term.weight * (weights_.array() * squared.pow(0.5 * p)).sum();
  const Eigen::VectorXd c = term.weight * p * weights_.array() * squared.pow(0.5 * p - 1.0);
  out.stiffness = c.sum();
  out.pull = out.stiffness * y - term.targets * c;
  return out;
}

Eigen::VectorXd Energy::observed(const KernelTerm& term, const Eigen::VectorXd& angles,
                                 const JointTransforms& transforms) const {
  if (term.space.is_angles) return angles;
  const auto& joints = term.space.joints;
  const auto count = joints.empty() ? transforms.end.size() : joints.size();
  Eigen::VectorXd y(3 * static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k)
    y.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        transforms.end[joints.empty() ? k : static_cast<std::size_t>(joints[k])];
  return y;
}

Eigen::MatrixXd Energy::observed_jacobian(const KernelTerm& term,
                                          const Eigen::MatrixXd& positions_by_basis,
                                          const Eigen::MatrixXd& basis) const {
  if (term.space.is_angles) return basis;
  const auto& joints = term.space.joints;
  if (joints.empty()) return positions_by_basis;
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(joints.size()), basis.cols());
  for (std::size_t k = 0; k < joints.size(); ++k)
    rows.middleRows(3 * static_cast<Eigen::Index>(k), 3) =
        positions_by_basis.middleRows(3 * joints[k], 3);
  return rows;
}

double Energy::value(const Eigen::VectorXd& angles) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  double sum = 0.0;
  for (const auto& term : terms_) {
    const Eigen::VectorXd y = observed(term, angles, transforms);
    sum += term.weight *
           (weights_.array() *
            ((term.targets.colwise() - y).colwise().squaredNorm().transpose().array() +
             kSoftening * kSoftening)
                .pow(0.5 * term.power))
               .sum();
  }
  return sum;
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
  double stiffness_of_all_positions = 0.0;
  for (const auto& term : terms_) {
    const Collapsed sum = collapse(term, observed(term, angles, transforms));
    model.value += sum.value;
    if (!term.space.is_angles && term.space.joints.empty()) {
      model.gradient.noalias() += positions_by_basis.transpose() * sum.pull;
      stiffness_of_all_positions += sum.stiffness;
      continue;
    }
    const Eigen::MatrixXd jacobian = observed_jacobian(term, positions_by_basis, basis);
    model.gradient.noalias() += jacobian.transpose() * sum.pull;
    model.hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose(), sum.stiffness);
  }
  if (stiffness_of_all_positions != 0.0)
    model.hessian.selfadjointView<Eigen::Lower>().rankUpdate(positions_by_basis.transpose(),
                                                             stiffness_of_all_positions);
  model.hessian.triangularView<Eigen::StrictlyUpper>() = model.hessian.transpose();
  return model;
}

}  // namespace sparse_mocap::tautges2011
