// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// How readings become poses: the stages that the paper compares, and two ways beside them.
enum class Mapping : int {
  phases,            // a perceptron for each phase, to latent points
  perceptron,        // one perceptron, to latent points
  linear,            // linear, to latent points
  direct_linear,     // linear, to poses
  gaussian_process,  // a Gaussian process, to poses
  path,              // the likeliest way through the training frames, to their latent points
};

// Everything that training and reconstruction can be told.
struct Config {
  // Training; a model remembers these.
  int site = 0;  // 0: both ankles; else an index in all_sites(), plus 1
  double position_along_bone = 1.0;
  double rate_hz = 30.0;
  int motion_frames = 150;            // of the first clips, that the motion model is learnt from
  double reading_smoothing_s = 0.02;  // beside the low-pass that all readings pass
  int window_frames = 8;              // that the mapping sees before and after each
  int latent_dimensions = 5;
  int iterations = 1500;
  int hidden_units = 20;
  double weight_decay = 1.0;

  // Reconstruction.
  Mapping mapping = Mapping::path;
  int vote_frames = 10;      // windows of the phase recognition
  double path_width = 0.5;   // of readings about those of a training frame, in deviations
  int smoothing_passes = 2;  // of the joints' rotations
  bool estimates_mounting = true;
  bool stops_skating = true;
  bool turns_by_gyroscope = true;
  double lag_ms = 300.0;  // of live poses
};

const std::vector<PresetInfo>& presets();
const OptionTable<Config>& options();

// Throws ConfigError.
Config with_settings(const MethodSettings& settings);

// The settings with those that the model was trained with. Throws ConfigError when one is asked for
// that the model was not trained with, and FormatError for a model without them.
Config with_model(const MethodSettings& settings, const Model& model);
// What with_model reads: the options that training knows, as they would be written.
std::map<std::string, std::string> training_options(const Config& config);

}  // namespace sparse_mocap::eom2014
