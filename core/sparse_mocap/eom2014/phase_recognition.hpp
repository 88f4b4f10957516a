// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/eom2014/hidden_markov_model.hpp"
#include "sparse_mocap/eom2014/phases.hpp"
#include "sparse_mocap/eom2014/readings.hpp"

namespace sparse_mocap::eom2014 {

// A classifier for each phase, and how readings are made discrete for them (Eom et al. 2014,
// sections 5.4 and 6.1).
struct PhaseRecognition {
  Eigen::Matrix<double, 1, 6> level_slope;  // per frame: steeper ones rise or fall
  std::vector<Phase> phases;
  std::vector<HiddenMarkovModel> models;  // of each phase

  // Of readings and the phase of each of their frames. Each stretch of a phase is a sequence.
  static PhaseRecognition trained(const std::vector<ReadingRows>& readings,
                                  const std::vector<std::vector<Phase>>& phases);

  // Whether each channel falls (0), is level (1) or rises (2); figure 5.
  Symbols discrete(const ReadingRows& readings) const;

  // The phase of each reading: every window of vote_frames votes for the phase whose model makes it
  // likeliest, and a reading has the phase that most of the windows over it vote for; figure 7.
  std::vector<Phase> recognised(const ReadingRows& readings, int vote_frames) const;
};

}  // namespace sparse_mocap::eom2014
