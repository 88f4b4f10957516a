// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// position_jacobian in the memory of an earlier one.
void put_position_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                           const JointTransforms& transforms, Eigen::MatrixXd& jacobian);

}  // namespace sparse_mocap
