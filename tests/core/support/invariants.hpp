// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap::testing {

// What must hold of anything that a reader hands out, whatever it read. Each call returns one line
// for everything that does not hold; an empty list is good. Tests and fuzzers ask the same.

using Violations = std::vector<std::string>;

// Names are unique UTF-8 text, parents precede children, lengths are finite, axes are frames, and
// angles are counted right.
Violations check_skeleton(const Skeleton& skeleton);

// The skeleton is sound, sizes agree, quaternions have unit length, the frame time is in range, and
// joints are at finite places.
Violations check_motion(const Motion& motion);

// The skeleton is sound, arrays have one row a frame and are finite, clips cover the frames.
Violations check_database(const MotionDatabase& database);

// All in one line, for messages.
std::string joined(const Violations& violations);

}  // namespace sparse_mocap::testing
