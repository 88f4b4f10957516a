// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sparse_mocap/reconstruction/pose_estimate.hpp"

namespace sparse_mocap::path_regression {

// A frame while it can still be worked on.
struct SolvedFrame {
  double time_s = 0.0;
  Eigen::VectorXd angles;     // 43, rad; the root's without heading
  Eigen::VectorXd positions;  // 63, m, heading frame: where the angles put the joints' ends
  Vec3 root_position = Vec3::Zero();
  double yaw_rad = 0.0;
  Eigen::Vector2d contacts = Eigen::Vector2d::Zero();
  Diagnostics diagnostics;
};

PoseEstimate to_estimate(SolvedFrame frame, const Skeleton& skeleton);

// Poses and root motion through a zero-phase low-pass of sigma_s (0: as they are); contacts and
// diagnostics stay.
std::vector<SolvedFrame> smoothed(std::vector<SolvedFrame> frames, const Skeleton& skeleton,
                                  double frame_time_s, double sigma_s);

}  // namespace sparse_mocap::path_regression
