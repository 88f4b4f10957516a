// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap::eom2014 {

// The motion of poses (frames x kNumPoseChannels) and of how the root moves into each (left,
// forward in m/s, turning in rad/s); it begins at the origin, facing forward.
Motion motion_of(const Skeleton& skeleton, double rate_hz, const Eigen::MatrixXd& poses,
                 const Eigen::MatrixX3d& root_velocities);

// Laplacian smoothing of joint rotations (Eom et al. 2014, section 6.2): each turns half of the way
// to the middle of those before and after it, as often as there are passes.
void smooth_rotations(Motion& motion, int passes);

// Moves the root so that feet that stand stay where they are (section 6.2); the correction is even
// over time.
void stop_skating(Motion& motion);

}  // namespace sparse_mocap::eom2014
