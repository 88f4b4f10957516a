// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/path_regression/frame_solver.hpp"

namespace sparse_mocap::path_regression {

// Whether the orientations of a take are to be turned to one heading: those with headings of their
// own, and those of trackers, which drift apart in long takes.
bool asks_for_headings(const FrameSolver& solver, std::size_t num_readings);

// Turns them to one heading (sensor_headings.hpp), by what is retrieved without them. Throws
// Cancelled.
void share_headings(const FrameSolver& solver, int num_threads, const Progress& progress,
                    std::vector<Reading>& take);

}  // namespace sparse_mocap::path_regression
