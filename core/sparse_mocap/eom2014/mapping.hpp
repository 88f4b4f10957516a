// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/eom2014/known_readings.hpp"

namespace sparse_mocap::eom2014 {

// Frames [begin, end) of a row of readings.
struct FrameRange {
  Eigen::Index begin = 0, end = 0;

  Eigen::Index size() const { return end - begin; }
};

// What a mapping finds for each reading of a range.
struct MappedFrames {
  std::vector<int> types;  // the likeliest, index in the model's
  std::vector<Phase> phases;
  std::vector<int> training_frames;  // the likeliest on the path, of that type
  Eigen::MatrixXd latent;  // of that type, frames x dimensions; no rows for mappings to poses
  Eigen::MatrixXd poses;   // frames x kNumPoseChannels
  std::vector<ExtremityVote> extremities;  // what the training frames have
  // How the root moves into each frame, as the last velocity channels: left, forward (m/s), turning
  // (rad/s). That of the take's first frame is zero.
  Eigen::MatrixX3d root_velocities;
};

// Readings, in the axes of the site, to poses (Eom et al. 2014, sections 5.5, 6.1 and 6.2). Where
// several types of motion are likely, poses are between theirs.
MappedFrames mapped(const TrainedModel& model, std::size_t site, const KnownReadings& known,
                    const ReadingRows& readings, const Config& config, const FrameRange& range);

}  // namespace sparse_mocap::eom2014
