// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/knn_index.hpp"

namespace sparse_mocap::retrieval {

// Orientations of several sensors as a search can compare them: the x and the z axis of each, seen
// from one heading that all of them share. That heading is the turn about the vertical that brings
// the axes nearest to those of the same sensors on a body in rest pose, so neither the world's
// north nor the performer's heading matters, and no sensor is the reference of the others.
//
// A row has six numbers a sensor; NaN where it says nothing.
inline constexpr Eigen::Index kAxesColumns = 6;

// Sets the shared heading to 0. sites: one a sensor, indices in all_sites().
void share_heading(std::span<const int> sites, Eigen::Ref<Eigen::RowVectorXf> axes);

// R_frame_sensor of a sensor from its six numbers; NaN where there are none.
Mat3 rotation_of_axes(const Eigen::Ref<const Eigen::RowVectorXf>& axes);

// The axes of a reading's sensors (columns of the reading).
Eigen::RowVectorXf axes_row(const Reading& reading, std::span<const Eigen::Index> sensors,
                            std::span<const int> sites);
void put_axes_row(const Reading& reading, std::span<const Eigen::Index> sensors,
                  std::span<const int> sites, Eigen::Ref<Eigen::RowVectorXf> row);

// Those that the sensors would have in each frame of the database, or had where its clips were
// performed with real ones.
FeatureRows database_axes(const MotionDatabase& database, std::span<const int> sites);

}  // namespace sparse_mocap::retrieval
