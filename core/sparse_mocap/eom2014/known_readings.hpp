// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/eom2014/trained_model.hpp"

namespace sparse_mocap::eom2014 {

// The readings of a site in all types of motion of a model, after one another and on one scale.
struct KnownReadings {
  ReadingRows rows;
  std::vector<int> begins;                // of the sequences
  std::vector<Eigen::Index> type_begins;  // of each type
  ReadingScale scale;

  static KnownReadings of(const TrainedModel& model, std::size_t site);
};

// How likely each type of motion is at each reading (readings x types, rows sum to 1), by the
// forward-backward algorithm: performers keep to a type for a while, and readings lie near those
// that its clips have.
Eigen::MatrixXd type_weights(const ReadingRows& readings, const KnownReadings& known);

}  // namespace sparse_mocap::eom2014
