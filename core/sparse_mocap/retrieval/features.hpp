// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::retrieval {

// A weighted average of the signals around a frame: a Gaussian, cut off at both ends. Times are
// relative to the frame, positive in the future.
struct SmoothedSignals {
  double centre_s = 0.0, sigma_s = 0.0;
  double from_s = 0.0, to_s = 0.0;
  double gain = 1.0;
};

// One part of what describes a frame in the search: a sum of averages.
using FeaturePart = std::vector<SmoothedSignals>;

// How much the signals of one frame count in a part.
struct Tap {
  int frame = 0;  // relative to the frame that is described, positive in the future
  double weight = 1.0;
};

// Feature parts at a frame rate. Taps are applied to the database's signals and to the measured
// ones alike, so neither lags behind the other.
struct FeatureLayout {
  std::vector<std::vector<Tap>> parts{{{0, 1.0}}};  // as in the paper: the frame's own signals

  FeatureLayout() = default;
  FeatureLayout(const std::vector<FeaturePart>& described, double rate_hz);

  int num_dimensions(int num_signals) const {
    return 3 * num_signals * static_cast<int>(parts.size());
  }
  int look_ahead() const;  // frames
  int reach_back() const;  // frames
};

// Rows [begin, end) of `rows` are a stretch without a cut, the feature that of row `at`. Beyond the
// stretch its first and its last row are repeated.
struct SignalWindow {
  const FeatureRows& rows;
  Eigen::Index begin, end, at;
};

// The feature of a row; weights scale the columns of the signals.
void feature_at(const SignalWindow& window, const FeatureLayout& layout,
                std::span<const float> weights, std::span<float> feature);

// The features of every frame of a database, given its signals; no window reaches beyond its clip.
FeatureRows database_features(const MotionDatabase& database, const FeatureRows& signals,
                              const FeatureLayout& layout, std::span<const float> weights);

}  // namespace sparse_mocap::retrieval
