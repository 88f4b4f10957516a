// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/pose_fit.hpp"

#include <utility>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::path_regression {
namespace {

bool is_on_limb(const Site& site) {
  using namespace standard_joint;
  return site.carrier != root && site.carrier != upperback && site.carrier != thorax &&
         site.carrier != head;
}

}  // namespace

PositionTarget position_target(double weight, const Eigen::MatrixXd& targets,
                               const Eigen::VectorXd& weights) {
  PositionTarget target{weight, targets * weights, 0.0};
  target.variance = (targets.colwise() - target.mean).colwise().squaredNorm().dot(weights);
  return target;
}

InclinationTarget inclination_target(double weight, const Skeleton& skeleton,
                                     const Reading& reading,
                                     std::span<const retrieval::Signal> signals) {
  InclinationTarget target{weight, {}, {}};
  std::vector<double> rises_m;
  for (const auto& signal : signals) {
    const Site& site = all_sites()[static_cast<std::size_t>(signal.site)];
    if (signal.channel != Channel::gravity_direction || !is_on_limb(site)) continue;
    const Vec3 up = reading.gravity_direction.col(signal.sensor);
    if (!(up.norm() > 0.0)) continue;
    // A sensor on a limb has its x axis along it, away from the body.
    rises_m.push_back(up.normalized().x() * skeleton.joint(site.carrier).bone.norm());
    target.joints.push_back(site.carrier);
  }
  target.rises_m =
      Eigen::Map<const Eigen::VectorXd>(rises_m.data(), static_cast<Eigen::Index>(rises_m.size()));
  return target;
}

PoseFit::PoseFit(const Skeleton& skeleton, std::vector<PositionTarget> positions,
                 InclinationTarget inclination)
    : skeleton_(skeleton), positions_(std::move(positions)), inclination_(std::move(inclination)) {}

Eigen::VectorXd PoseFit::rise_residuals(const JointTransforms& transforms) const {
  Eigen::VectorXd residuals = -inclination_.rises_m;
  for (Eigen::Index k = 0; k < residuals.size(); ++k) {
    const int joint = inclination_.joints[static_cast<std::size_t>(k)];
    const int parent = skeleton_.joint(joint).parent;
    residuals[k] += kUp.dot(transforms.end[static_cast<std::size_t>(joint)] -
                            transforms.end[static_cast<std::size_t>(parent)]);
  }
  return residuals;
}

double PoseFit::value(const Eigen::VectorXd& angles) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  const Eigen::VectorXd y = stacked_ends(transforms);
  double total = inclination_.weight * rise_residuals(transforms).squaredNorm();
  for (const auto& [weight, mean, variance] : positions_)
    total += weight * ((y - mean).squaredNorm() + variance);
  return total;
}

PoseFit::Model PoseFit::majorised(const Eigen::VectorXd& angles,
                                  const Eigen::MatrixXd& basis) const {
  JointTransforms transforms;
  forward_kinematics(skeleton_, Vec3::Zero(), angles, transforms);
  const Eigen::VectorXd y = stacked_ends(transforms);
  const Eigen::MatrixXd jacobian = position_jacobian(skeleton_, angles, transforms) * basis;
  Model model{0.0, Eigen::VectorXd::Zero(basis.cols()),
              Eigen::MatrixXd::Zero(basis.cols(), basis.cols())};
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(y.size());
  double stiffness = 0.0;
  for (const auto& [weight, mean, variance] : positions_) {
    model.value += weight * ((y - mean).squaredNorm() + variance);
    pull += 2.0 * weight * (y - mean);
    stiffness += 2.0 * weight;
  }
  model.gradient.noalias() += jacobian.transpose() * pull;
  auto hessian = model.hessian.selfadjointView<Eigen::Lower>();
  hessian.rankUpdate(jacobian.transpose(), stiffness);

  const Eigen::VectorXd residuals = rise_residuals(transforms);
  Eigen::MatrixXd rises(residuals.size(), basis.cols());
  for (Eigen::Index k = 0; k < residuals.size(); ++k) {
    const int joint = inclination_.joints[static_cast<std::size_t>(k)];
    const int parent = skeleton_.joint(joint).parent;
    rises.row(k) =
        kUp.transpose() * (jacobian.middleRows(3 * joint, 3) - jacobian.middleRows(3 * parent, 3));
  }
  model.value += inclination_.weight * residuals.squaredNorm();
  model.gradient.noalias() += 2.0 * inclination_.weight * rises.transpose() * residuals;
  hessian.rankUpdate(rises.transpose(), 2.0 * inclination_.weight);
  model.hessian.triangularView<Eigen::StrictlyUpper>() = model.hessian.transpose();
  return model;
}

}  // namespace sparse_mocap::path_regression
