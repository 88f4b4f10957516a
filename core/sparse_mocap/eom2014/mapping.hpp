// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/eom2014/trained_model.hpp"

namespace sparse_mocap::eom2014 {

// How the root moves from the frame before, as the last velocity channels: left, forward (m/s),
// turning (rad/s).
using RootVelocity = Eigen::Vector3d;

// What a mapping finds for each reading.
struct MappedFrames {
  Eigen::MatrixXd latent;  // frames x dimensions; no rows for mappings straight to poses
  std::vector<Phase> phases;
  Eigen::MatrixXd poses;             // frames x kNumPoseChannels
  Eigen::MatrixX3d root_velocities;  // of the step to each frame; the first is not used
};

// Readings, in the axes of the site, to poses (Eom et al. 2014, sections 5.5, 6.1 and 6.2).
MappedFrames mapped(const TrainedModel& model, const SiteModel& site, const ReadingRows& readings,
                    const Config& config);

}  // namespace sparse_mocap::eom2014
