// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "sparse_mocap/reconstruction/method_info.hpp"
#include "sparse_mocap/reconstruction/options.hpp"

namespace sparse_mocap::tautges2011 {

// Which model of probability the energy is made of; the paper compares them in figure 11.
enum class PriorModel {
  kernel,       // (a) kernel regression, equations (5), (7), (8), (11)
  mahalanobis,  // (b) Mahalanobis distances in place of the kernels
  normal,       // (c) a normal distribution of poses and an ad-hoc smoothness, as Chai and Hodgins
};

// How a pose is made from the retrieved ones.
enum class PoseSource {
  energy,  // the paper's: the minimum of equation (2)
  mean,    // their weighted mean alone: what the energy is worth
};

// What the paper leaves open or states as a number.
struct Config {
  int num_neighbours = 4096;    // K, section 6.3
  int num_paths = 256;          // I, section 6.3
  int window_readings = 20;     // M; the paper states no number
  double penalty = 1.0;         // of an unmatched reading, in distances of its farthest neighbour
  bool is_time_warping = true;  // figure 13
  PriorModel prior = PriorModel::kernel;
  PoseSource pose = PoseSource::energy;

  // Section 5.3.
  double w_contr = 1.0;
  double w_prior = 5.0;
  double w_pose = 0.6;
  double w_motion = 0.2;
  double w_smooth = 0.2;
  double pca_variance = 0.99;
  int max_iterations = 50;

  // One departure from the paper: its K and I are meant for 560,000 frames. As many of a small
  // database mix unrelated motions, so K is at most kNeighbourShare of the frames, and I as great a
  // share of them as in the paper, but at least kFewestPaths.
  bool scales_with_database = true;
  static constexpr double kNeighbourShare = 0.05;
  static constexpr double kPathShare = 256.0 / 560'000.0;
  static constexpr int kFewestPaths = 32;

  // The other: the poses that the paper's energy gives jump where the paths change, so what is
  // shown follows them with a lag. The method itself goes on from its own poses. 0: shows these.
  double follow_s = 0.15;

  // K and I for a database that has so many searched frames.
  Config scaled_to(int num_frames) const;
};

const std::vector<PresetInfo>& presets();
const OptionTable<Config>& options();

// Throws ConfigError for an unknown preset or option, or a value that cannot be.
Config config_of(const MethodSettings& settings);

}  // namespace sparse_mocap::tautges2011
