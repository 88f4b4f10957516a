// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/reconstruction/options.hpp"
#include "sparse_mocap/retrieval/features.hpp"

namespace sparse_mocap::path_regression {

// Everything that a reconstruction can be told. The defaults are what live and whole takes share.
struct Config {
  // Retrieval.
  int num_neighbours = 4096;              // at most kNeighbourShare of the searched frames
  double leg_weight = 1.6;                // of sensors on legs, in the search
  double gravity_weight_mps2 = 9.81;      // what a unit of gravity direction counts there
  double orientation_weight_mps2 = 12.0;  // and what a unit of a sensor's axes counts
  // How much nearer frames count whose readings real sensors measured.
  double real_preference = 0.0;
  // Whether sensors with a gyroscope are used as orientations too, whose headings are found as the
  // take goes, by poses of the last heading_memory_s.
  bool use_own_headings = true;
  double heading_memory_s = 20.0;
  bool use_tempo_copies = true;  // search clips at other tempos than performed as well
  double penalty = 0.8;          // of an unmatched reading, in distances of its farthest neighbour
  double forgetting = 0.9;       // how much a reading counts one reading later
  std::vector<retrieval::FeaturePart> features;
  static constexpr double kNeighbourShare = 0.5;

  // Weights of the paths.
  int num_paths = 256;  // at most a quarter of the neighbours
  double sharpness = 1.3;

  // Local regression from signals to poses; 0 turns it off. The ridge is in units of the mean
  // variance of its features.
  double regression_ridge = 6.0;
  std::vector<retrieval::FeaturePart> regression_features;

  // What poses and root are fitted to.
  FitWeights fit;
  double wide_spread_m = 0.15;  // poses that differ so much count half
  int max_iterations = 10;

  // Whole takes: how many other motions to look for that the readings leave possible.
  int alternatives = 0;
  static constexpr int kMostAlternatives = 2;

  // Live: how long a pose waits for readings after its own, s. Retrieval looks the least lag ahead;
  // for the rest of it the pose is held back.
  double lag_s = kLeastLag_s;
  static constexpr double kLeastLag_s = 0.04, kMostLag_s = 0.4;
  int held_frames(double rate_hz) const;
};

// Each pose must be ready soon. Throws ConfigError.
Config live_config(const MethodSettings& settings = {});
// Every pose may depend on the whole take. Throws ConfigError.
Config whole_take_config(const MethodSettings& settings = {});

const std::vector<PresetInfo>& presets();
const OptionTable<Config>& options();

}  // namespace sparse_mocap::path_regression
