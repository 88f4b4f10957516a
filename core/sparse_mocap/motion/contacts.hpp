// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// When the left (row 0) and right (row 1) foot stand on the floor: 1, else 0; 2 x frames.
//
// The standard skeleton ends at the ankles, so an ankle stands for its foot: it does while it is
// lower than 6 cm above its lowest stand in the motion and slower than 0.5 m/s.
Eigen::Matrix2Xd foot_contacts(const Motion& standard_motion);

}  // namespace sparse_mocap
