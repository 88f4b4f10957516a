// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/extremity_vote.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap::retrieval {

ExtremityVote extremity_vote(const MotionDatabase& database, const WeightedPaths& weighted) {
  ExtremityVote vote;
  if (database.extremities().rows() == 0) return vote;
  std::array<Eigen::Vector4d, kNumExtremities> sums;
  sums.fill(Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < weighted.paths.size(); ++i) {
    const int frame = weighted.paths[i].frame;
    const double weight = weighted.weights[static_cast<Eigen::Index>(i)];
    const Clip& clip = clip_at(database, frame);
    for (std::size_t e = 0; e < sums.size(); ++e) {
      if (!clip.has_extremity[e] || weight <= 0.0) continue;
      const auto column = static_cast<Eigen::Index>(3 * e);
      const Vec3 vector =
          database.extremities().row(frame).segment<3>(column).transpose().cast<double>();
      const Eigen::Vector4d q = rotation_of_vector(vector).coeffs();
      sums[e] += (q.dot(sums[e]) < 0.0 ? -weight : weight) * q;
      vote.certainty[e] += weight;
    }
  }
  for (std::size_t e = 0; e < sums.size(); ++e) {
    vote.certainty[e] = std::min(vote.certainty[e], 1.0);  // weights sum to 1 but for rounding
    if (sums[e].norm() > 0.0) vote.R_parent_joint[e] = Quat(sums[e].normalized());
  }
  return vote;
}

}  // namespace sparse_mocap::retrieval
