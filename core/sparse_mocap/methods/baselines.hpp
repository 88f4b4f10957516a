// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/readings/reading.hpp"

namespace sparse_mocap {

// What every method is compared with. Each gives one database frame a reading; clips in
// excluded_clips and copies at other tempos are never used.

// Plays back the database: the frame at the end of the best path of the online lazy neighbourhood
// graph (K = 4096, raw readings).
std::vector<int> playback_best_path(const MotionDatabase& database,
                                    const std::vector<Sensor>& sensors,
                                    const std::vector<Reading>& take,
                                    const std::vector<int>& excluded_clips);

// The frame whose last `window` readings are nearest to the take's (the idea of Slyper and Hodgins
// 2008).
std::vector<int> nearest_windows(const MotionDatabase& database, const std::vector<Sensor>& sensors,
                                 const std::vector<Reading>& take, int window,
                                 const std::vector<int>& excluded_clips);

// The frame whose pose is nearest to the true one (positions: 63 x frames, m, heading frame): what
// retrieval could reach at best.
std::vector<int> nearest_poses(const MotionDatabase& database, const Eigen::MatrixXd& positions,
                               const std::vector<int>& excluded_clips);

// What the paths of a take cost by the online graph, and by one that is made anew for each reading
// from the last `window` of them, as before Tautges et al. 2011 (section 4; K = 4096, raw
// readings).
struct GraphTimes {
  double online_s = 0.0, anew_s = 0.0;  // a reading, processor time of the graphs alone
  double same = 0.0;                    // share of the readings with the same best path's end
};
GraphTimes graph_times(const MotionDatabase& database, const std::vector<Sensor>& sensors,
                       const std::vector<Reading>& take, int window,
                       const std::vector<int>& excluded_clips);

}  // namespace sparse_mocap
