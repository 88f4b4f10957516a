// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::retrieval {

// Three axes of a reading that are compared with the database.
struct Signal {
  Eigen::Index sensor = 0;  // column of the reading
  int site = 0;             // index in all_sites()
  double position_along_bone = 1.0;
  // Or gravity_direction; or orientation, of which a sensor has two signals, one after the other:
  // its x and its z axis as shared_heading.hpp has them.
  Channel channel = Channel::specific_force;
};

// The specific force of every sensor and then, if wanted, the gravity direction of those that give
// it. Throws ConfigError when there is no sensor, or two at one site.
std::vector<Signal> compared_signals(const std::vector<Sensor>& sensors, bool with_gravity);
// The same with gravity, and then the axes of those that have an orientation.
std::vector<Signal> all_signals(const std::vector<Sensor>& sensors);

// Whether the sensor's site is on a thigh or a shank.
bool is_on_leg(const Signal& signal);

// The signals that worn sensors would give in each frame of the database: frames x 3 signals.
// Throws ConfigError when the database lacks a site.
FeatureRows database_signals(const MotionDatabase& database, std::span<const Signal> signals);

// The same of a reading: a row of 3 signals.
Eigen::RowVectorXf signal_row(const Reading& reading, std::span<const Signal> signals);
void put_signals(const Reading& reading, std::span<const Signal> signals,
                 Eigen::Ref<Eigen::RowVectorXf> row);

// Which frames are searched: not those of excluded clips, nor, unless wanted, copies at another
// tempo. Throws ConfigError for an excluded clip that does not exist, and when no frame is left.
std::vector<bool> searched_frames(const MotionDatabase& database, bool use_tempo_copies,
                                  const std::vector<int>& excluded_clips);

}  // namespace sparse_mocap::retrieval
