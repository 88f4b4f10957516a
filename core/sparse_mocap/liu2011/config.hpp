// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/liu2011/history_search.hpp"
#include "sparse_mocap/liu2011/map_estimate.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/reconstruction/options.hpp"

namespace sparse_mocap::liu2011 {

// What is known of a pose before the sensors are asked; section 7 compares them.
enum class PriorModel {
  dynamic,             // online local linear dynamic models: the paper's
  local_pca,           // online local PCA, as Chai and Hodgins 2005
  inverse_kinematics,  // near the pose before, and nothing of the database
};

// What the paper leaves open: it states no number but the sensors' rate.
struct Config {
  PriorModel prior = PriorModel::dynamic;

  // Section 5.
  int num_neighbours = 150;  // K
  double history_s = 0.1;    // m poses span it
  double pca_variance = 0.8;
  double deviation_floor_deg = 3.0;  // of sigma_d; else it vanishes where all examples are still
  double root_deviation_floor_m = 0.01;
  // A departure from the paper: what the sensors say counts in the search, too.
  double search_position_per_m = 10.0;
  double search_orientation = 8.0;

  // Section 6.
  double sigma_position_m = 0.01;
  double sigma_orientation_deg = 2.0;
  double robustness = 3.0;
  int max_iterations = 20;

  // Beyond the paper.
  double history_trust = 0.4;       // of the synthesised history, which the paper takes for exact
  bool joint_residuals = true;      // residuals of degrees of freedom go together
  double motion_deviation_m = 0.0;  // of sensors from how their accelerations move them; 0: unused
  double heading_drift_deg = 0.0;   // of each sensor's heading, in a second; 0: it does not drift
  double restart_after_s = 0.4;     // without track of the sensors; 0: never
  double evenness_deg = 1.0;        // best quality: of angles from even movement, frame by frame
  double agreement_deg = 3.0;       // and from the mean of both ways through the take

  // The baselines.
  double local_pca_variance = 0.99;
  double smoothness_deg = 10.0;  // how far a pose is from moving on evenly
  double ik_deviation_deg = 30.0;

  int num_poses(double rate_hz) const;
  ControlWeights control() const;
};

const std::vector<PresetInfo>& presets();
const OptionTable<Config>& options();

// Throws ConfigError for an unknown preset or option, or a value that cannot be.
Config config_of(const MethodSettings& settings);

}  // namespace sparse_mocap::liu2011
