// SPDX-License-Identifier: GPL-3.0-or-later
//
// What exporters put into motion files that is no movement.
#pragma once

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// The motion without tracks that draw a joint into its parent: their exporters (MakeHuman) write
// position channels relative to the OFFSET. num_dropped (may be null): how many there were.
Motion without_collapsed_offsets(const Motion& source, int* num_dropped = nullptr);

// How many frames stand before the movement: exporters put a rest pose or a T-pose there.
int num_leading_rest_frames(const Motion& motion);

}  // namespace sparse_mocap
