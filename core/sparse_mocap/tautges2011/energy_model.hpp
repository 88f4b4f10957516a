// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "sparse_mocap/retrieval/neighbourhood.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/tautges2011/config.hpp"
#include "sparse_mocap/tautges2011/derivatives.hpp"
#include "sparse_mocap/tautges2011/energy.hpp"

namespace sparse_mocap::tautges2011 {

// What is known of the performance up to time t.
struct Past {
  Eigen::VectorXd angles;            // q^t, rad
  Eigen::VectorXd positions;         // x^t, m, heading frame
  Eigen::VectorXd positions_before;  // x^(t-1)
  Eigen::Matrix3Xd accelerations;    // alpha-hat^t, m/s^2, heading frame; 3 x signals
};

// What the energy of time t + 1 is made of.
struct Evidence {
  const retrieval::Neighbourhood& neighbours;
  const PathDerivatives& derivatives;
  const std::optional<Past>& past;  // nothing: only the pose prior can be formed
  std::span<const retrieval::Signal> signals;
  double dt_s;
};

// How evidence becomes an energy. The paper compares three ways (figure 11, section 6.2.5); a
// reconstruction has one of them for good.
class EnergyModel {
 public:
  virtual ~EnergyModel() = default;
  // In the memory of the terms of an earlier frame.
  virtual void put_terms(const Evidence& evidence, EnergyTerms& terms) const = 0;
};

std::unique_ptr<const EnergyModel> make_energy_model(const Config& config);

// The normal distribution of a kernel term's targets, each direction's variance floored: its
// squared Mahalanobis distance as a share of the dimensions.
NormalTerm normal_term(const KernelTerm& kernel, const Eigen::VectorXd& weights);

}  // namespace sparse_mocap::tautges2011
