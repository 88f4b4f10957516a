// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
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

// What is learnt of one type of motion, such as walking: the paper has a model for each.
struct MotionType {
  std::string name;           // the clips' class; may be empty
  std::vector<int> begins;    // first frames of the motion model's sequences
  std::vector<Phase> phases;  // of its frames
  MotionModel motion;
  ExtremityRows extremities;     // of its frames
  std::vector<SiteModel> sites;  // the same sites in every type
};

// Everything that training learns.
struct TrainedModel {
  Skeleton skeleton;  // of the first clip's performer
  std::vector<MotionType> types;

  const std::vector<SiteModel>& sites() const { return types.front().sites; }
};

// Learns each class of clips as a type of motion: the motion from its first clips and the phases
// from all of them (Eom et al. 2014, section 5). Throws ConfigError for clips that cannot be used,
// and Cancelled.
TrainedModel trained_model(const Config& config, const std::vector<TrainingClip>& clips,
                           const Progress& progress);

// The phases that training finds in a clip. Throws ConfigError for a clip without steps.
std::vector<Segment> found_phases(const Config& config, const TrainingClip& clip);

// As a model file keeps it.
Model stored(const TrainedModel& trained, const Config& config);
// Throws FormatError.
TrainedModel restored(const Model& model, const Config& config);

}  // namespace sparse_mocap::eom2014
