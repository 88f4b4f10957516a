// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sparse_mocap/liu2011/body_pose.hpp"
#include "sparse_mocap/liu2011/worn_sensors.hpp"

namespace sparse_mocap::liu2011 {

// The accelerations of sensors without gravity (m/s^2), one column a sensor, in the world; NaN
// where a sensor does not tell its specific force and its orientation.
Eigen::Matrix3Xd linear_accelerations(const Reading& reading);

// Gives sensors with an orientation but no position the one to which their acceleration moves them
// on from the two newest poses: 2 p_(t-1) - p_(t-2) + a_(t-1) dt^2. recent: the newest first, in
// the frame of the observations, as accelerations are, which are those of the newest pose.
void add_moved_positions(const Skeleton& body, std::span<const BodyPose> recent,
                         const Eigen::Matrix3Xd& accelerations, double frame_time_s,
                         double looseness, std::vector<Observation>& observed);

}  // namespace sparse_mocap::liu2011
