// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/config.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr std::array<std::string_view, 10> kTrainingOptions{
    "site",          "position_along_bone", "rate_hz",    "motion_frames", "reading_smoothing_s",
    "window_frames", "latent_dimensions",   "iterations", "hidden_units",  "weight_decay"};

bool is_of_training(std::string_view option) {
  return std::find(kTrainingOptions.begin(), kTrainingOptions.end(), option) !=
         kTrainingOptions.end();
}

std::vector<std::string> site_choices() {
  std::vector<std::string> choices{"ankles"};
  for (const auto& site : all_sites()) choices.emplace_back(site.name);
  return choices;
}

Config preset(const std::string& name) {
  Config config;
  if (name.empty() || name == presets()[0].name) return config;
  if (name != presets()[1].name)
    throw ConfigError("unknown preset '" + name + "'; eom2014 has default, paper");
  config.mapping = Mapping::phases;
  config.window_frames = 0;
  config.turns_by_gyroscope = false;
  return config;
}

void add_training(OptionTable<Config>& table) {
  table
      .choice("site", &Config::site, site_choices(),
              "training: where the sensor is worn, or at either ankle")
      .number("position_along_bone", &Config::position_along_bone, 0.0, 1.0,
              "training: where simulated sensors sit, from 0 at the knee to 1 at the ankle")
      .number("rate_hz", &Config::rate_hz, 10.0, 120.0,
              "training: frames a second of the model and of what it reconstructs")
      .integer("motion_frames", &Config::motion_frames, 10, 2000,
               "training: frames of the first clips that the motion is learnt from")
      .number("reading_smoothing_s", &Config::reading_smoothing_s, 0.0, 1.0,
              "training: width of the Gaussian filter of readings, s")
      .integer("window_frames", &Config::window_frames, 0, 60,
               "training: readings before and after each that the mapping sees")
      .integer("latent_dimensions", &Config::latent_dimensions, 1, 20,
               "training: dimensions of the latent space")
      .integer("iterations", &Config::iterations, 1, 100'000,
               "training: iterations of L-BFGS for the motion model, at most")
      .integer("hidden_units", &Config::hidden_units, 1, 1000,
               "training: hidden units of a perceptron")
      .number("weight_decay", &Config::weight_decay, 0.0, 1e6,
              "training: weight decay of a perceptron");
}

OptionTable<Config> all_options() {
  OptionTable<Config> table;
  table
      .choice("mapping", &Config::mapping,
              {"phases", "perceptron", "linear", "direct_linear", "gaussian_process", "path"},
              "how readings become poses: by a perceptron for each phase, by a single one, "
              "linearly, linearly or by a Gaussian process without the latent space, or along the "
              "likeliest path through the training frames")
      .integer("vote_frames", &Config::vote_frames, 1, 1000,
               "frames of the windows that vote for a phase")
      .number("path_width", &Config::path_width, 1e-3, 1e3,
              "how far readings are from those of a training frame, in standard deviations")
      .integer("smoothing_passes", &Config::smoothing_passes, 0, 1000,
               "how often the joints' rotations are smoothed")
      .flag("estimates_mounting", &Config::estimates_mounting,
            "whether the sensor may be turned on its limb; the movement tells how")
      .flag("stops_skating", &Config::stops_skating, "whether standing feet stay in place")
      .flag("turns_by_gyroscope", &Config::turns_by_gyroscope,
            "whether the body turns as the gyroscope does, rather than as in the clips")
      .number("lag_ms", &Config::lag_ms, 0.0, 2000.0,
              "live: how long a pose waits for further readings, ms");
  add_training(table);
  return table;
}

}  // namespace

const std::vector<PresetInfo>& presets() {
  static const std::vector<PresetInfo> list{
      {"default", "What came closest to recorded motion in the evaluation."},
      {"paper", "As published: a perceptron for each phase, from one reading at a time."}};
  return list;
}

const OptionTable<Config>& options() {
  static const auto table = all_options();
  return table;
}

Config with_settings(const MethodSettings& settings) {
  Config config = preset(settings.preset);
  options().apply(settings.options, config);
  return config;
}

std::map<std::string, std::string> training_options(const Config& config) {
  std::map<std::string, std::string> values;
  for (const auto& option : options().described(config))
    if (is_of_training(option.name)) values[option.name] = option.default_value;
  return values;
}

Config with_model(const MethodSettings& settings, const Model& model) {
  OptionValues trained;
  for (const std::string_view name : kTrainingOptions) {
    const auto found = model.metadata.find(std::string(name));
    if (found == model.metadata.end())
      throw FormatError({model.path}, "the model does not say its " + std::string(name),
                        "train it again with this version");
    trained[std::string(name)] = found->second;
  }
  Config config = preset(settings.preset);
  options().apply(settings.options, config);
  const auto asked = training_options(config);
  for (const auto& [name, text] : settings.options)
    if (is_of_training(name) && asked.at(name) != trained[name])
      throw ConfigError("the model was trained with " + name + " " + trained[name] + ", not " +
                        text + "; train one with --set " + name + "=" + text);
  options().apply(trained, config);
  return config;
}

}  // namespace sparse_mocap::eom2014
