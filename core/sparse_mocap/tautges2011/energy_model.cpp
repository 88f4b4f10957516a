// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/energy_model.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <utility>

#include "sparse_mocap/tautges2011/control.hpp"
#include "sparse_mocap/tautges2011/prior.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

// (a) Kernel regression: equations (2) and (3).
class KernelModel : public EnergyModel {
 public:
  explicit KernelModel(const Config& config) : config_(config) {}

  EnergyTerms terms(const Evidence& evidence) const override {
    const auto& [neighbours, derivatives, past, signals, dt_s] = evidence;
    EnergyTerms out;
    out.kernels.push_back(pose_prior(neighbours, config_));  // equation (5)
    if (!past) return out;
    const auto& [angles, x, x_before, accelerations] = *past;
    out.kernels.push_back(motion_prior(derivatives, config_, x, dt_s));  // equation (7)
    out.kernels.push_back(
        smoothness_prior(derivatives, config_, x, x_before, dt_s));  // equation (8)
    out.kernels.push_back(
        control_term(derivatives, config_, x, accelerations, signals, dt_s));  // equation (11)
    return out;
  }

 private:
  Config config_;
};

// (b) The Mahalanobis distance in place of each kernel sum.
class MahalanobisModel : public EnergyModel {
 public:
  explicit MahalanobisModel(const Config& config) : kernels_(config) {}

  EnergyTerms terms(const Evidence& evidence) const override {
    EnergyTerms out;
    for (const auto& kernel : kernels_.terms(evidence).kernels)
      if (kernel.weight > 0.0)
        out.normals.push_back(normal_term(kernel, evidence.neighbours.weights));
    return out;
  }

 private:
  KernelModel kernels_;
};

// (c) As Chai and Hodgins 2005: a normal distribution of poses, and joints that accelerate little.
// "Little" is measured by how much the retrieved motions do.
class NormalModel : public EnergyModel {
 public:
  explicit NormalModel(const Config& config) : config_(config) {}

  EnergyTerms terms(const Evidence& evidence) const override {
    const auto& [neighbours, derivatives, past, signals, dt_s] = evidence;
    EnergyTerms out;
    out.normals.push_back(normal_term(pose_prior(neighbours, config_), neighbours.weights));
    if (!past) return out;
    const auto& [angles, x, x_before, accelerations] = *past;
    const auto control = control_term(derivatives, config_, x, accelerations, signals, dt_s);
    if (control.weight > 0.0) out.normals.push_back(normal_term(control, neighbours.weights));
    const double bend_m =
        derivatives.accelerations.norm() * dt_s * dt_s /
        std::sqrt(static_cast<double>(derivatives.accelerations.cols()));  // of a whole pose
    out.normals.push_back(
        {{},
         config_.w_prior * config_.w_smooth,
         2.0 * x - x_before,
         Eigen::MatrixXd::Identity(x.size(), x.size()) / std::max(bend_m, Energy::kSoftening)});
    return out;
  }

 private:
  Config config_;
};

}  // namespace

std::unique_ptr<const EnergyModel> make_energy_model(const Config& config) {
  if (config.prior == PriorModel::mahalanobis) return std::make_unique<MahalanobisModel>(config);
  if (config.prior == PriorModel::normal) return std::make_unique<NormalModel>(config);
  return std::make_unique<KernelModel>(config);
}

NormalTerm normal_term(const KernelTerm& kernel, const Eigen::VectorXd& weights) {
  NormalTerm term{kernel.space, kernel.weight, kernel.targets * weights, {}};
  const Eigen::MatrixXd rooted =
      (kernel.targets.colwise() - term.mean) * weights.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rooted * rooted.transpose());
  const Eigen::ArrayXd deviations =
      eigen.eigenvalues().array().max(Energy::kSoftening * Energy::kSoftening).sqrt();
  const double root_dimensions = std::sqrt(static_cast<double>(deviations.size()));
  term.whitening = (1.0 / (root_dimensions * deviations)).matrix().asDiagonal() *
                   eigen.eigenvectors().transpose();
  return term;
}

}  // namespace sparse_mocap::tautges2011
