// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/extremity_rows.hpp"

#include <algorithm>

namespace sparse_mocap::eom2014 {

ExtremityRows extremity_rows(const Motion& motion) {
  ExtremityRows rows = ExtremityRows::Zero(motion.num_frames(), kExtremityColumns);
  if (!has_extremities(motion.skeleton)) return rows;
  for (int t = 0; t < motion.num_frames(); ++t)
    for (int e = 0; e < kNumExtremities; ++e)
      rows.row(t).segment<4>(4 * e) = motion.rotation(t, extremity_joint(e)).coeffs().transpose();
  return rows;
}

std::vector<ExtremityVote> extremity_votes(const ExtremityRows& rows,
                                           const Eigen::MatrixXd& weights) {
  std::vector<ExtremityVote> votes(static_cast<std::size_t>(weights.rows()));
  for (Eigen::Index t = 0; t < weights.rows(); ++t) {
    ExtremityVote& vote = votes[static_cast<std::size_t>(t)];
    for (std::size_t e = 0; e < kNumExtremities; ++e) {
      const auto column = static_cast<Eigen::Index>(4 * e);
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      double known = 0.0;
      for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const Eigen::Vector4d q = rows.row(i).segment<4>(column).transpose();
        sum += (q.dot(sum) < 0.0 ? -weights(t, i) : weights(t, i)) * q;
        known += weights(t, i) * q.norm();
      }
      vote.certainty[e] = std::min(known, 1.0);  // weights sum to 1 but for rounding
      if (sum.norm() > 0.0) vote.R_parent_joint[e] = Quat(sum.normalized());
    }
  }
  return votes;
}

}  // namespace sparse_mocap::eom2014
