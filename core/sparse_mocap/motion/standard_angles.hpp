// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// Pose vectors (43 angles, rad) of a motion on a standard skeleton, continuous in time.
// 43 x frames.
Eigen::MatrixXd standard_angles(const Motion& standard_motion);

}  // namespace sparse_mocap
