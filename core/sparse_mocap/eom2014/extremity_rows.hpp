// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap::eom2014 {

// Feet, toes and hands of training frames, a row a frame: quaternions R_parent_joint (x y z w) in
// the order of extremity::Index; zeros where they are not known.
inline constexpr int kExtremityColumns = 4 * kNumExtremities;
using ExtremityRows = Eigen::Matrix<double, Eigen::Dynamic, kExtremityColumns, Eigen::RowMajor>;

// Those of a motion; zeros for a skeleton that ends at wrists and ankles.
ExtremityRows extremity_rows(const Motion& motion);

// Weighted means on the rotation group (the unit quaternion nearest to the weighted sum) over the
// training frames that know them. weights: instants x training frames, rows sum to 1.
std::vector<ExtremityVote> extremity_votes(const ExtremityRows& rows,
                                           const Eigen::MatrixXd& weights);

}  // namespace sparse_mocap::eom2014
