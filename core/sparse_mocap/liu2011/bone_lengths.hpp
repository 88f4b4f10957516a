// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap::liu2011 {

// The bones of a standard skeleton that have a length: all but the root's.
inline constexpr int kNumBoneLengths = kNumStandardJoints - 1;

// s of Liu et al. 2011, section 4: the lengths of all bones (m), that of joint j + 1 at j.
using BoneLengths = Eigen::Matrix<double, kNumBoneLengths, 1>;

// One body to learn from.
struct MeasuredBody {
  BoneLengths lengths_m = BoneLengths::Zero();
  std::array<bool, kNumBoneLengths> is_known{};  // what its file said
};

// How long people's bones are: normal in a principal subspace, and a little beside it. Equation
// (1)'s last term with its lambda_b, which are standard normal here, left to take their best
// values.
struct BoneLengthModel {
  BoneLengths mean_m = BoneLengths::Zero();                      // e_0
  Eigen::Matrix<double, kNumBoneLengths, Eigen::Dynamic> modes;  // e_b, times its deviation (m)
  double deviation_m = 0.01;                                     // of each length beside them

  Eigen::MatrixXd covariance() const;  // of the lengths, m^2
};

// The shares of the standing height that body segments have (Drillis and Contini 1966, as in
// Winter, Biomechanics and Motor Control of Human Movement, figure 4.1), for adults of 1.71 m on
// average, who differ by 0.09 m in height and by 5 % of a length in the proportions of trunk, legs,
// arms and widths. Bones that they do not name are those of the medium body.
BoneLengthModel published_bone_lengths();

// Probabilistic principal components of bodies and their mirror images, by expectation and
// maximisation, so that bodies of which lengths are missing count for the others (Tipping and
// Bishop 1999). As many modes as asked for, or fewer for a few bodies. Throws ConfigError for fewer
// than three bodies, and for a bone that no body has.
BoneLengthModel learnt_bone_lengths(const std::vector<MeasuredBody>& bodies, int num_modes = 5);

// The lengths of a body that was read from a motion file. Bones that are exactly as long as in the
// medium body, scaled to the legs, were filled in by the import: the file did not say.
MeasuredBody measured_body(const StandardBones& bones);

BoneLengths lengths_of(const StandardBones& bones);
// The medium body's bones with other lengths.
StandardBones bones_of_lengths(const BoneLengths& lengths_m);

// Kept as a model of the method. bone_lengths_in throws FormatError.
Model to_model(const BoneLengthModel& lengths);
BoneLengthModel bone_lengths_in(const Model& model);

}  // namespace sparse_mocap::liu2011
