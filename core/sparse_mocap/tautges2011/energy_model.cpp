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

  void put_terms(const Evidence& evidence, EnergyTerms& out) const override {
    const auto& [neighbours, derivatives, past, signals, dt_s] = evidence;
    auto& terms = out.kernels;
    terms.resize(past ? 4 : 1);
    put_pose_prior(neighbours, config_, terms[0]);  // equation (5)
    if (!past) return;
    const auto& [angles, x, x_before, accelerations] = *past;
    put_motion_prior(derivatives, config_, x, dt_s, terms[1]);                // equation (7)
    put_smoothness_prior(derivatives, config_, x, x_before, dt_s, terms[2]);  // equation (8)
    put_control_term(derivatives, config_, x, accelerations, signals, dt_s,
                     terms[3]);  // equation (11)
  }

 private:
  Config config_;
};

// (b) The Mahalanobis distance in place of each kernel sum.
class MahalanobisModel : public EnergyModel {
 public:
  explicit MahalanobisModel(const Config& config) : kernels_(config) {}

  void put_terms(const Evidence& evidence, EnergyTerms& out) const override {
    EnergyTerms kernels;
    kernels_.put_terms(evidence, kernels);
    out.normals.clear();
    for (const auto& kernel : kernels.kernels)
      if (kernel.weight > 0.0)
        out.normals.push_back(normal_term(kernel, evidence.neighbours.weights));
  }

 private:
  KernelModel kernels_;
};

// (c) As Chai and Hodgins 2005: a normal distribution of poses, and joints that accelerate little.
// "Little" is measured by how much the retrieved motions do.
class NormalModel : public EnergyModel {
 public:
  explicit NormalModel(const Config& config) : config_(config) {}

  void put_terms(const Evidence& evidence, EnergyTerms& out) const override {
    const auto& [neighbours, derivatives, past, signals, dt_s] = evidence;
    out.normals.clear();
    KernelTerm pose, control;
    put_pose_prior(neighbours, config_, pose);
    out.normals.push_back(normal_term(pose, neighbours.weights));
    if (!past) return;
    const auto& [angles, x, x_before, accelerations] = *past;
    put_control_term(derivatives, config_, x, accelerations, signals, dt_s, control);
    if (control.weight > 0.0) out.normals.push_back(normal_term(control, neighbours.weights));
    const double bend_m =
        derivatives.accelerations.norm() * dt_s * dt_s /
        std::sqrt(static_cast<double>(derivatives.accelerations.cols()));  // of a whole pose
    out.normals.push_back(
        {{},
         config_.w_prior * config_.w_smooth,
         2.0 * x - x_before,
         Eigen::MatrixXd::Identity(x.size(), x.size()) / std::max(bend_m, Energy::kSoftening)});
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
  const auto targets = kernel.compared_targets();
  NormalTerm term{kernel.space, kernel.weight, targets * weights, {}};
  const Eigen::MatrixXd rooted = (targets.colwise() - term.mean) * weights.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rooted * rooted.transpose());
  const Eigen::ArrayXd deviations =
      eigen.eigenvalues().array().max(Energy::kSoftening * Energy::kSoftening).sqrt();
  const double root_dimensions = std::sqrt(static_cast<double>(deviations.size()));
  term.whitening = (1.0 / (root_dimensions * deviations)).matrix().asDiagonal() *
                   eigen.eigenvectors().transpose();
  return term;
}

}  // namespace sparse_mocap::tautges2011
