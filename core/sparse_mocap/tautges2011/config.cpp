// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/config.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

void require(double value, double lowest, double highest, const char* name) {
  if (value >= lowest && value <= highest) return;
  throw ConfigError(std::string(name) + " must be between " + std::to_string(lowest) + " and " +
                    std::to_string(highest) + ", got " + std::to_string(value));
}

Config paper() {
  Config config;
  // The paper does not state M; it found any from 8 on alike (figure 9b).
  config.olng.forgetting = 1.0;
  config.olng.window = 20;
  // K = 4096 and I = 256 are meant for its 560,000 frames. As many on a small database mix
  // unrelated motions.
  config.neighbour_fraction = 0.05;
  config.path_fraction = 256.0 / 560'000.0;
  return config;
}

// 0.5 (part, frames later minus part, frames earlier).
std::vector<Tap> half_change(const std::vector<Tap>& part, int later, int earlier) {
  std::vector<Tap> change;
  for (const Tap& tap : part) {
    change.push_back({tap.frame + later, 0.5 * tap.weight});
    change.push_back({tap.frame - earlier, -0.5 * tap.weight});
  }
  return change;
}

// What online and offline share.
Config best_measured_alike() {
  Config config;
  config.leg_weight = 1.6;
  config.up_weight_mps2 = kGravity_mps2;
  config.w_inclination = 30.0;
  config.use_tempo_copies = true;
  config.neighbour_fraction = 0.5;
  config.olng.penalty = 0.8;
  config.weight_rule = WeightRule::softmax;
  config.sharpness = 1.3;
  config.regression_ridge = 6.0;
  config.kernel_power = 2.0;
  config.pose_space = PoseSpace::positions;
  config.motion_rule = MotionRule::exact;
  config.w_smooth = 0.0;
  config.w_contr = 0.0;
  config.pca_variance = 0.999;
  config.is_multi_start = true;
  config.foot_lock = 0.8;
  return config;
}

// The readings around a frame, smoothed, and how they change across it; nothing hurries.
Config best_measured_offline() {
  Config config = best_measured_alike();
  config.num_paths = 512;
  config.sharpness = 1.4;
  const auto now = gaussian_taps(0.0, 1.0, -5, 5);
  config.features.parts = {now, half_change(now, 3, 3)};
  config.olng.forgetting = 0.95;
  config.regression_features.parts.clear();
  for (const auto& [centre, sigma] : {std::pair{2, 0.7}, {6, 1.0}, {12, 2.0}})
    for (const int side : {-1, 1})
      config.regression_features.parts.push_back(
          gaussian_taps(side * centre, sigma, side * centre - 6, side * centre + 6));
  config.w_pose = 1.0;
  config.w_motion = 0.0;
  config.offline_smoothing_s = 0.036;
  return config;
}

// Found by trial on HDM05 (scenarios 1 and 3). Retrieval looks one frame ahead.
Config best_measured() {
  constexpr int kAhead = 1;
  Config config = best_measured_alike();
  const auto now = gaussian_taps(0.0, 1.0, -5, kAhead);
  config.features.parts = {now, half_change(now, 0, 4)};
  config.olng.forgetting = 0.9;
  config.regression_features.parts = {
      gaussian_taps(1.0, 0.7, -3, kAhead), gaussian_taps(-1.0, 0.7, -5, kAhead),
      gaussian_taps(-4.0, 1.0, -9, kAhead), gaussian_taps(-8.0, 1.5, -15, kAhead),
      gaussian_taps(-14.0, 2.0, -22, kAhead)};
  config.w_pose = 0.5;
  config.w_motion = 0.5;
  config.offline = std::make_shared<const Config>(best_measured_offline());
  return config;
}

}  // namespace

void Config::validate() const {
  require(num_neighbours, 1, 1e6, "num_neighbours (K)");
  require(neighbour_fraction, 1e-6, 1.0, "neighbour_fraction");
  require(num_paths, 1, num_neighbours, "num_paths (I)");
  require(leg_weight, 1e-3, 1e3, "leg_weight");
  require(up_weight_mps2, 0.0, 1e3, "up_weight_mps2");
  require(path_fraction, 1e-9, 1.0, "path_fraction");
  require(olng.penalty, 0.0, 100.0, "olng.penalty");
  require(olng.forgetting, 0.0, 1.0, "olng.forgetting");
  require(olng.window, 0, 10000, "olng.window (M)");
  require(sharpness, 0.0, 1e3, "sharpness");
  require(offline_smoothing_s, 0.0, 1.0, "offline_smoothing_s");
  require(regression_ridge, 0.0, 1e9, "regression_ridge");
  require(kernel_power, 0.1, 2.0, "kernel_power");
  require(pca_variance, 0.01, 1.0, "pca_variance");
  require(max_iterations, 1, 10000, "max_iterations");
  require(foot_lock, 0.0, 1.0, "foot_lock");
  for (const double weight : {w_prior, w_pose, w_motion, w_smooth, w_contr, w_inclination})
    require(weight, 0.0, 1e6, "an energy weight");
  if (w_prior * w_pose <= 0.0) throw ConfigError("w_prior and w_pose must be positive");
  if (offline) offline->validate();
  if (features.parts.empty()) throw ConfigError("features need at least one part");
}

Config preset(std::string_view name) {
  if (name == "paper") return paper();
  if (name == "default") return best_measured();
  throw ConfigError("unknown preset '" + std::string(name) + "'; known are default, paper");
}

const std::vector<std::string_view>& preset_names() {
  static const std::vector<std::string_view> names{"default", "paper"};
  return names;
}

}  // namespace sparse_mocap::tautges2011
