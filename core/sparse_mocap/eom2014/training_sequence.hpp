// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sparse_mocap/eom2014/extremity_rows.hpp"
#include "sparse_mocap/eom2014/motion_model.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::eom2014 {

// Readings of the one sensor, a row each: specific force (m/s^2), angular velocity (rad/s).
using ReadingRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

// Channels of poses: the standard skeleton's angles (rad), the root's without heading, and the
// root's height (m).
inline constexpr int kHeightChannel = kNumStandardAngles;
inline constexpr int kNumPoseChannels = kNumStandardAngles + 1;
// Channels of velocities: of each channel of poses, and of the root over the floor, left and
// forward in the heading of the frame before (m/s) and turning (rad/s).
inline constexpr int kRootVelocityChannel = kNumPoseChannels;
inline constexpr int kNumVelocityChannels = kNumPoseChannels + 3;

// A training clip as methods see it: at the model's rate, frames as rows.
struct TrainingSequence {
  std::string name;
  Eigen::MatrixXd poses;       // frames x kNumPoseChannels
  Eigen::MatrixXd velocities;  // frames - 1 x kNumVelocityChannels, of the steps
  Eigen::Matrix2Xd contacts;   // as foot_contacts
  ReadingRows readings;        // of a sensor at the site
  ExtremityRows extremities;   // feet, toes and hands
};

struct SequenceSettings {
  int site = 0;
  double position_along_bone = 1.0;
  double rate_hz = 30.0;
};

// The clips, their angles near those of the first; feet, toes and hands where their skeletons have
// them. Readings that were recorded with a clip are
// used, others are simulated. Throws ConfigError for a clip that is too short, or whose recording
// lacks the site or a gyroscope.
std::vector<TrainingSequence> training_sequences(const std::vector<TrainingClip>& clips,
                                                 const SequenceSettings& settings);

// Several sequences after one another; no step leads from one into the next.
MotionData joined(const std::vector<TrainingSequence>& sequences);

}  // namespace sparse_mocap::eom2014
