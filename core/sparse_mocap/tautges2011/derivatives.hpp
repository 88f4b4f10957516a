// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/retrieval/olng.hpp"

namespace sparse_mocap::tautges2011 {

// How the joints move where the paths end (Tautges et al. 2011, section 5); heading frame, one
// column a path.
struct PathDerivatives {
  Eigen::MatrixXd velocities;         // V, 63 x I, m/s
  Eigen::MatrixXd accelerations;      // A, 63 x I, m/s^2
  Eigen::MatrixXd velocities_before;  // 63 x I, m/s: at the frame that the path passed before
};

PathDerivatives path_derivatives(const MotionDatabase& database,
                                 std::span<const retrieval::Path> paths);
void put_path_derivatives(const MotionDatabase& database, std::span<const retrieval::Path> paths,
                          PathDerivatives& derivatives);

// Central differences of the positions' rows (63), inside the frame's clip; 0 in clips of fewer
// than three frames.
void kinematics_at(const MotionDatabase& database, int frame, Eigen::Ref<Eigen::VectorXd> velocity,
                   Eigen::Ref<Eigen::VectorXd> acceleration);

}  // namespace sparse_mocap::tautges2011
