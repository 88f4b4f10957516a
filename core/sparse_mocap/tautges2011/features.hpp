// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/database/index.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/reconstruction/method.hpp"

namespace sparse_mocap::tautges2011 {

// One reading of a window and how much it counts.
struct Tap {
  int frame = 0;  // relative to the frame that is described, positive in the future
  double weight = 1.0;
};

// What describes a frame in the search: for each part, a weighted sum of the readings around it.
//
// The paper describes a frame by its own reading, one part with one tap. The same sums are formed
// of the database's virtual readings and of the measured ones, so no part is late.
struct FeatureLayout {
  std::vector<std::vector<Tap>> parts{{{0, 1.0}}};

  int num_dimensions(int num_sensors) const {
    return 3 * num_sensors * static_cast<int>(parts.size());
  }
  int look_ahead() const;  // frames
  int reach_back() const;  // frames
};

// The taps of a Gaussian around centre, cut to frames [first, last] and normalised to sum 1.
std::vector<Tap> gaussian_taps(double centre, double sigma_frames, int first, int last);

// The readings of frame rows, 3 x sensors columns: what the worn sensors would read.
FeatureRows database_readings(const MotionDatabase& database,
                              const std::vector<WornSensor>& sensors);

// The features of every row; windows do not reach over clip borders, where the outermost reading
// holds. weights scale the readings' columns (one for each of 3 x sensors).
FeatureRows database_features(const MotionDatabase& database, const FeatureRows& readings,
                              const FeatureLayout& layout, std::span<const float> weights);

// The features of row `at`; of the readings only rows [begin, end) are looked at, and the outermost
// hold beyond.
void feature_at(const FeatureRows& readings, Eigen::Index begin, Eigen::Index end, Eigen::Index at,
                const FeatureLayout& layout, std::span<const float> weights,
                std::span<float> feature);

}  // namespace sparse_mocap::tautges2011
