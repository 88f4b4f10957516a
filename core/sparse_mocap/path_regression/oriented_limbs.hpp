// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/readings/reading.hpp"
#include "sparse_mocap/retrieval/signals.hpp"

namespace sparse_mocap::path_regression {

// R_heading_sensor of the sensors on a pose, given as pose_points with the same lever; zero where
// orientations are not compared. R: one a sensor of the reading. The points may be a mean over
// poses: rotations on which these disagree are shorter then.
void put_posed_sensors(const Skeleton& skeleton, std::span<const retrieval::Signal> signals,
                       double lever_m, const Eigen::VectorXd& points, std::vector<Mat3>& R);

// Turns the limbs with sensors as these measure it, from where retrieved poses have elbows, knees,
// neck and pelvis; one turn about the vertical, common to all sensors, is fitted to the points.
// points: as pose_points, with the same lever; row: a row of the signals. Returns how many sensors
// had an orientation.
int place_oriented_limbs(const Skeleton& skeleton, std::span<const retrieval::Signal> signals,
                         const Eigen::Ref<const Eigen::RowVectorXf>& row, double lever_m,
                         Eigen::VectorXd& points);

}  // namespace sparse_mocap::path_regression
