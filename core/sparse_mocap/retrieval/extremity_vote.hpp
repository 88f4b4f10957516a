// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/pose_estimate.hpp"
#include "sparse_mocap/retrieval/neighbourhood.hpp"

namespace sparse_mocap::retrieval {

// The weighted mean of the retrieved frames' feet, toes and hands on the rotation group (the unit
// quaternion nearest to the weighted sum), over the frames whose files have them.
ExtremityVote extremity_vote(const MotionDatabase& database, const WeightedPaths& weighted);

}  // namespace sparse_mocap::retrieval
