// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/eom2014/config.hpp"
#include "sparse_mocap/eom2014/extremity_rows.hpp"
#include "sparse_mocap/eom2014/motion_model.hpp"
#include "sparse_mocap/eom2014/perceptron.hpp"
#include "sparse_mocap/eom2014/phase_recognition.hpp"

namespace sparse_mocap::eom2014 {

// What the readings of a sensor at one site mean.
struct SiteModel {
  int site = 0;          // index in all_sites()
  ReadingRows readings;  // of the motion model's frames
  ReadingScale scale;    // of those
  PhaseRecognition recognition;
  Perceptron perceptron;                  // from features to latent points
  std::vector<Perceptron> of_each_phase;  // in the order of recognition.phases
};

// Everything that training learns.
struct TrainedModel {
  Skeleton skeleton;        // of the first clip's performer
  std::vector<int> begins;  // first frames of the motion model's sequences
  MotionModel motion;
  ExtremityRows extremities;  // of the motion model's frames
  std::vector<SiteModel> sites;
};

// Learns the motion from the first clips and the phases from all (Eom et al. 2014, section 5).
// Throws ConfigError for clips that cannot be used, and Cancelled.
TrainedModel trained_model(const Config& config, const std::vector<TrainingClip>& clips,
                           const Progress& progress);

// As a model file keeps it.
Model stored(const TrainedModel& trained, const Config& config);
// Throws FormatError.
TrainedModel restored(const Model& model, const Config& config);

// The features of a model's own frames; windows end where sequences do.
Eigen::MatrixXd training_features(const SiteModel& site, const std::vector<int>& begins,
                                  int window);

}  // namespace sparse_mocap::eom2014
