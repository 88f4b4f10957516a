// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/config.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::liu2011 {

int Config::num_poses(double rate_hz) const {
  return std::max(2, static_cast<int>(std::lround(history_s * rate_hz)));
}

ControlWeights Config::control() const {
  return {sigma_position_m, sigma_orientation_deg * kRadiansPerDegree, robustness};
}

const std::vector<PresetInfo>& presets() {
  static const std::vector<PresetInfo> list{
      {"default", "The paper's method, with the sensors in the search."},
      {"paper", "The paper alone: histories are searched without the sensors."}};
  return list;
}

const OptionTable<Config>& options() {
  static const auto table =
      OptionTable<Config>()
          .choice("prior", &Config::prior, {"dynamic", "local_pca", "inverse_kinematics"},
                  "what is known of a pose before the sensors are asked; the paper compares them")
          .integer("num_neighbours", &Config::num_neighbours, 2, 100'000,
                   "K: motion examples that a model is learnt from")
          .number("history_s", &Config::history_s, 0.02, 2.0, "how long the compared histories are")
          .number("pca_variance", &Config::pca_variance, 0.01, 1.0,
                  "share of the histories' variance that is regressed on")
          .number("deviation_floor_deg", &Config::deviation_floor_deg, 1e-3, 90.0,
                  "least deviation of a predicted angle")
          .number("root_deviation_floor_m", &Config::root_deviation_floor_m, 1e-4, 1.0,
                  "least deviation of the predicted root position")
          .number("search_position_per_m", &Config::search_position_per_m, 0.0, 1e3,
                  "what a metre between sensors counts in the search, in radians of a joint")
          .number("search_orientation", &Config::search_orientation, 0.0, 1e3,
                  "what a radian between sensors counts in the search, in radians of a joint")
          .number("sigma_position_m", &Config::sigma_position_m, 1e-4, 1.0,
                  "deviation of measured positions")
          .number("sigma_orientation_deg", &Config::sigma_orientation_deg, 0.01, 90.0,
                  "deviation of measured orientations")
          .number("robustness", &Config::robustness, 0.1, 1e3,
                  "deviations beyond which errors of sensors count ever less")
          .integer("max_iterations", &Config::max_iterations, 1, 10'000,
                   "steps of the optimisation, at most")
          .number("history_trust", &Config::history_trust, 0.0, 1.0,
                  "how much the poses before are believed, in which errors remain: 1, as in the "
                  "paper, they are exact; 0: examples are all that is known")
          .flag("joint_residuals", &Config::joint_residuals,
                "whether errors of a prediction go together, or each angle's is on its own, as in "
                "the paper")
          .number("motion_deviation_m", &Config::motion_deviation_m, 0.0, 10.0,
                  "deviation of sensors without a position from how their accelerations move them, "
                  "m a frame; 0: accelerations are not used")
          .number("heading_drift_deg", &Config::heading_drift_deg, 0.0, 90.0,
                  "how far a sensor's heading drifts in a second; 0: headings are trusted")
          .number("restart_after_s", &Config::restart_after_s, 0.0, 60.0,
                  "how long sensors may be off before the search begins anew; 0: never")
          .number("evenness_deg", &Config::evenness_deg, 0.01, 1e3,
                  "best quality: deviation from even movement, of each angle")
          .number("agreement_deg", &Config::agreement_deg, 0.01, 1e3,
                  "best quality: deviation from the mean of both ways through the take")
          .number("local_pca_variance", &Config::local_pca_variance, 0.01, 1.0,
                  "local_pca: share of the variance that poses may vary in")
          .number("smoothness_deg", &Config::smoothness_deg, 0.01, 1e3,
                  "local_pca: deviation from even movement, of each angle")
          .number("ik_deviation_deg", &Config::ik_deviation_deg, 0.01, 1e3,
                  "inverse_kinematics: deviation from the pose before, of each angle");
  return table;
}

Config config_of(const MethodSettings& settings) {
  Config config;
  if (settings.preset == "paper") {
    config.search_position_per_m = 0.0;
    config.search_orientation = 0.0;
    config.joint_residuals = false;
    config.history_trust = 1.0;
  } else if (!settings.preset.empty() && settings.preset != "default") {
    throw ConfigError("unknown preset '" + settings.preset + "'; liu2011 has default and paper");
  }
  options().apply(settings.options, config);
  return config;
}

}  // namespace sparse_mocap::liu2011
