// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::retrieval {

// How much nearer frames count whose signals real sensors measured (Clip::take): one factor a clip,
// 1 where all its signals are virtual and 1 - preference where all are real. Empty when no clip has
// any, or nothing is preferred.
std::vector<float> distance_factors(const MotionDatabase& database, std::span<const Signal> signals,
                                    double preference);

// Multiplies the distances by their clips' factors, and brings the neighbours into order again.
void scale_distances(const MotionDatabase& database, std::span<const float> factors,
                     std::span<Neighbour> neighbours);

}  // namespace sparse_mocap::retrieval
