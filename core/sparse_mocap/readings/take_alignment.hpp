// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sparse_mocap/base/progress.hpp"
#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/readings/reading_stream.hpp"

namespace sparse_mocap {

// Where in a take a motion was performed, and how well the two agree.
//
// Correlations compare what the sensors measured with what virtual ones read, around their means,
// each sensor turned as fits best (Kabsch: Acta Cryst. A 32, 1976), so that they say nothing about
// how it is mounted. They are 1 at most; those of unrelated movements are about 0.5.
struct TakeAlignment {
  double begin_s = 0.0;                     // when the motion begins, on the take's clock
  double correlation = 0.0;                 // over all sensors, while both last
  double runner_up = 0.0;                   // the best at another time
  double coverage = 0.0;                    // part of the motion during which the take was recorded
  std::vector<double> sensor_correlations;  // one a sensor
};

// Finds a motion of the standard skeleton in a take by the correlation of all sensors' readings.
// The sensors share a clock. event: when a clap or a jump, which the motion has too, happened on
// that clock; it then decides the time, and the correlation is still that of everything. Throws
// ConfigError for what is too short to be compared, and Cancelled.
TakeAlignment align_take(const Motion& standard_motion, std::span<const SensorRecording> take,
                         std::span<const SensorInput> sensors,
                         std::optional<std::pair<double, double>> event,
                         const Progress& progress = Progress());

}  // namespace sparse_mocap
