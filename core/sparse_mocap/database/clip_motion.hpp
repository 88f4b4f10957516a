// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// A clip of a database as a motion in the world: poses from the rows, the root by integration from
// the origin. Throws std::out_of_range for an index that no clip has.
Motion clip_motion(const MotionDatabase& database, int clip_index);

// The same with feet, toes and hands, which are relaxed in clips whose files have none.
Motion clip_motion_with_extremities(const MotionDatabase& database, int clip_index);

}  // namespace sparse_mocap
