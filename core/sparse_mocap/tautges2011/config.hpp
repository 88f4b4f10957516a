// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "sparse_mocap/tautges2011/features.hpp"
#include "sparse_mocap/tautges2011/olng.hpp"

namespace sparse_mocap::tautges2011 {

// How path rewards become weights.
enum class WeightRule {
  linear,   // equation (1)
  softmax,  // exp(sharpness * (reward - best) / standard deviation of the rewards)
};

// In which space poses are compared by the pose prior.
enum class PoseSpace { angles, positions };

// Which displacement the motion prior expects of a retrieved frame.
enum class MotionRule {
  taylor,  // equation (6): v dt + a dt^2 / 2
  exact,   // the step that the database clip takes into that frame
};

// Everything that a reconstruction can be told. Angles in rad, positions in m.
struct Config {
  static constexpr int kFewestPaths = 32;

  // Retrieval, sections 3 and 4.
  int num_neighbours = 4096;  // K, at most neighbour_fraction of the database
  double neighbour_fraction = 0.25;
  FeatureLayout features;
  double leg_weight = 1.0;        // of the sensors on legs in the search
  double up_weight_mps2 = 0.0;    // what a unit of direction against gravity counts there
  bool use_tempo_copies = false;  // search clips at other tempos than performed as well
  OlngConfig olng;

  // Weights, equation (1).
  int num_paths = 256;         // I, at most a quarter of K
  double path_fraction = 1.0;  // I is at most this share of the database, or kFewestPaths
  WeightRule weight_rule = WeightRule::linear;
  double sharpness = 1.0;  // softmax only

  // Local regression from readings to poses over the paths; 0 turns it off. The ridge is in units
  // of the mean variance of its features.
  double regression_ridge = 0.0;
  FeatureLayout regression_features;

  // Energy, equations (2), (3), (5), (7), (8), (11).
  double w_prior = 5.0;
  double w_pose = 0.6;
  double w_motion = 0.2;
  double w_smooth = 0.2;
  double w_contr = 1.0;
  double w_inclination = 0.0;  // of limbs whose direction against gravity is measured
  double kernel_power = 0.5;   // the paper's square root; 2 gives weighted means
  PoseSpace pose_space = PoseSpace::angles;
  MotionRule motion_rule = MotionRule::taylor;

  // Minimisation, section 5.3.
  double pca_variance = 0.99;
  int max_iterations = 50;
  bool is_multi_start = false;  // start also from the weighted mean and the best path

  // Root motion, section 6.4: weight of standing feet against the neighbours' mean.
  double foot_lock = 0.0;

  // Offline only.
  double offline_smoothing_s = 0.0;       // standard deviation of the final low-pass
  std::shared_ptr<const Config> offline;  // what to use instead of these settings; null: nothing

  // Throws ConfigError naming the setting and its range.
  void validate() const;
};

// "paper": the paper's formulas and weights. "default": what measures best.
Config preset(std::string_view name);
const std::vector<std::string_view>& preset_names();

}  // namespace sparse_mocap::tautges2011
