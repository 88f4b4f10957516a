// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/config.hpp"

#include <array>
#include <cmath>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::path_regression {
namespace {

using retrieval::FeaturePart;
using retrieval::SmoothedSignals;

// Half of what the average is later_s later minus what it is earlier_s earlier.
FeaturePart half_change(const SmoothedSignals& average, double later_s, double earlier_s) {
  const auto moved = [&](double by_s, double gain) {
    return SmoothedSignals{average.centre_s + by_s, average.sigma_s, average.from_s + by_s,
                           average.to_s + by_s, gain};
  };
  return {moved(later_s, 0.5), moved(-earlier_s, -0.5)};
}

constexpr double kLiveLookAhead_s = Config::kLeastLag_s;

void apply(const MethodSettings& settings, Config& config) {
  if (!settings.preset.empty() && settings.preset != presets().front().name)
    throw ConfigError("unknown preset '" + settings.preset + "'; path_regression has default");
  options().apply(settings.options, config);
}

}  // namespace

int Config::held_frames(double rate_hz) const {
  return static_cast<int>(std::floor((lag_s - kLiveLookAhead_s) * rate_hz + 1e-6));
}

// Found by trial on HDM05, for known and unknown performers.
Config live_config(const MethodSettings& settings) {
  Config config;
  const SmoothedSignals now{0.0, 0.04, -0.2, kLiveLookAhead_s};
  config.features = {{now}, half_change(now, 0.0, 0.16)};
  config.regression_features = {{{0.04, 0.028, -0.12, kLiveLookAhead_s}},
                                {{-0.04, 0.028, -0.2, kLiveLookAhead_s}},
                                {{-0.16, 0.04, -0.36, kLiveLookAhead_s}},
                                {{-0.32, 0.06, -0.6, kLiveLookAhead_s}},
                                {{-0.56, 0.08, -0.88, kLiveLookAhead_s}}};
  config.fit.lever_m = 0.2;
  config.fit.step = 2.0;
  config.fit.smoothness = 16.0;
  apply(settings, config);
  return config;
}

Config whole_take_config(const MethodSettings& settings) {
  Config config;
  const SmoothedSignals now{0.0, 0.04, -0.2, 0.2};
  config.features = {{now}, half_change(now, 0.12, 0.12)};
  config.forgetting = 0.95;
  config.num_paths = 512;
  config.sharpness = 1.4;
  for (const auto& [centre_s, sigma_s] :
       {std::array{0.08, 0.028}, std::array{0.24, 0.04}, std::array{0.48, 0.08}})
    for (const double side : {-1.0, 1.0})
      config.regression_features.push_back(
          {{side * centre_s, sigma_s, side * centre_s - 0.24, side * centre_s + 0.24}});
  config.fit.lever_m = 0.2;
  config.fit.step = 3.0;
  config.fit.smoothness = 8.0;
  // An elbow that passes through straight turns the upper arm over within a frame where it may not
  // bend a little too far on the way.
  config.fit.hinge = 0.0;
  config.wide_spread_m = 0.07;
  apply(settings, config);
  return config;
}

const std::vector<PresetInfo>& presets() {
  static const std::vector<PresetInfo> list{
      {"default", "What came closest to recorded motion in the evaluation."}};
  return list;
}

const OptionTable<Config>& options() {
  static const auto table =
      OptionTable<Config>()
          .integer("num_neighbours", &Config::num_neighbours, 1, 1'000'000,
                   "frames of the database that are retrieved for each reading")
          .integer("num_paths", &Config::num_paths, 1, 1'000'000,
                   "best paths that the pose is made from")
          .number("leg_weight", &Config::leg_weight, 1e-3, 1e3,
                  "weight of sensors on legs in the search")
          .number("gravity_weight_mps2", &Config::gravity_weight_mps2, 0.0, 1e3,
                  "what a unit of gravity direction counts in the search")
          .number("orientation_weight_mps2", &Config::orientation_weight_mps2, 0.0, 1e3,
                  "what a unit of the axes of sensors with an orientation counts in the search")
          .number("real_preference", &Config::real_preference, -10.0, 0.99,
                  "how much nearer frames count whose readings real sensors measured; below 0: "
                  "farther")
          .flag(
              "use_own_headings", &Config::use_own_headings,
              "whether the turns of sensors with a gyroscope are followed, so that they say where "
              "limbs point")
          .number("heading_memory_s", &Config::heading_memory_s, 1.0, 1e4,
                  "how long poses count by which the headings of such sensors are found, s")
          .flag("use_tempo_copies", &Config::use_tempo_copies,
                "whether copies of the clips at other tempos are searched")
          .number("penalty", &Config::penalty, 0.0, 100.0,
                  "cost of a reading that a path skips, in distances of its farthest neighbour")
          .number("forgetting", &Config::forgetting, 0.0, 1.0,
                  "how much a reading counts one reading later")
          .number("sharpness", &Config::sharpness, 0.0, 1e3,
                  "how much better paths count more than others")
          .number("regression_ridge", &Config::regression_ridge, 0.0, 1e9,
                  "ridge of the regression from readings to poses; 0: no regression")
          .number("step_weight", &Config::fit, &FitWeights::step, 0.0, 1e6,
                  "weight of the retrieved movement into a frame; that of retrieved poses is 1")
          .number("smoothness", &Config::fit, &FitWeights::smoothness, 0.0, 1e6,
                  "weight of even movement from frame to frame where retrieved poses differ")
          .number("calm_mps", &Config::fit, &FitWeights::calm_mps, 1e-3, 1e6,
                  "how fast joints move for which even movement counts half, m/s")
          .number("twist_lever_m", &Config::fit, &FitWeights::lever_m, 1e-3, 1.0,
                  "how far out a bone's turn about itself is compared, m")
          .number("wide_spread_m", &Config::wide_spread_m, 1e-3, 1e3,
                  "how far retrieved poses lie apart that count half, m")
          .number("gravity_weight", &Config::fit, &FitWeights::inclination, 0.0, 1e6,
                  "weight of the limbs' measured inclination")
          .number("contact_weight", &Config::fit, &FitWeights::contact, 0.0, 1e6,
                  "how firmly a standing foot stays in place; it may roll as retrieved ones do")
          .number("stands_from", &Config::fit, &FitWeights::stands_from, 0.0, 1.0,
                  "certainty below which a foot does not stand")
          .number("stands_at", &Config::fit, &FitWeights::stands_at, 0.0, 1.0,
                  "certainty from which on a foot stands for good")
          .number("foot_height_weight", &Config::fit, &FitWeights::foot_height, 0.0, 1e6,
                  "how firmly feet stand on the floor, and none below it")
          .number("turning_weight", &Config::fit, &FitWeights::turning, 0.0, 1e6,
                  "weight of the measured turning about the vertical")
          .number("root_weight", &Config::fit, &FitWeights::root_step, 0.0, 1e6,
                  "weight of the root's retrieved movement")
          .number("root_turn_weight", &Config::fit, &FitWeights::root_turn, 0.0, 1e6,
                  "weight of the root's retrieved turning")
          .number("root_smoothness", &Config::fit, &FitWeights::root_smoothness, 0.0, 1e6,
                  "weight of even movement of the root")
          .number("hinge_weight", &Config::fit, &FitWeights::hinge, 0.0, 1e6,
                  "how firmly knees and elbows stay within the range in which they bend")
          .number(
              "lag_s", &Config::lag_s, Config::kLeastLag_s, Config::kMostLag_s,
              "live: how long a pose waits for readings after its own, s; one that waits is more "
              "accurate")
          .integer("alternatives", &Config::alternatives, 0, Config::kMostAlternatives,
                   "best quality: how many other motions to look for that fit the readings about "
                   "as well")
          .integer("max_iterations", &Config::max_iterations, 1, 10'000,
                   "steps of the fit, at most");
  return table;
}

}  // namespace sparse_mocap::path_regression
