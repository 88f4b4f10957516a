// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/solved_frame.hpp"

#include <utility>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap::path_regression {
namespace {

// Angles, root position and yaw as one column a frame; angles are unwound so that neighbouring
// frames can be averaged.
Eigen::MatrixXd pose_columns(const std::vector<SolvedFrame>& frames) {
  const Eigen::Index angles = frames.front().angles.size();
  Eigen::MatrixXd columns(angles + 4, static_cast<Eigen::Index>(frames.size()));
  for (Eigen::Index t = 0; t < columns.cols(); ++t) {
    const SolvedFrame& frame = frames[static_cast<std::size_t>(t)];
    columns.col(t) << frame.angles, frame.root_position, frame.yaw_rad;
    if (t == 0) continue;
    auto now = columns.col(t).head(angles).array();
    now -= 2.0 * kPi * ((now - columns.col(t - 1).head(angles).array()) / (2.0 * kPi)).round();
  }
  return columns;
}

}  // namespace

PoseEstimate to_estimate(SolvedFrame frame, const Skeleton& skeleton) {
  return {frame.time_s, pose_rotations(skeleton, frame.angles, frame.yaw_rad), frame.root_position,
          frame.contacts, std::move(frame.diagnostics)};
}

std::vector<SolvedFrame> smoothed(std::vector<SolvedFrame> frames, const Skeleton& skeleton,
                                  double frame_time_s, double sigma_s) {
  if (frames.empty() || sigma_s <= 0.0) return frames;
  std::vector<double> times_s;
  for (std::size_t t = 0; t < frames.size(); ++t)
    times_s.push_back(static_cast<double>(t) * frame_time_s);
  const Eigen::MatrixXd smooth =
      filtered_at(times_s, pose_columns(frames), times_s, GaussianFilter{sigma_s});
  JointTransforms pose;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const auto column = smooth.col(static_cast<Eigen::Index>(t));
    const Eigen::Index angles = frames[t].angles.size();
    frames[t].angles = column.head(angles);
    frames[t].root_position = column.segment<3>(angles);
    frames[t].yaw_rad = column[angles + 3];
    forward_kinematics(skeleton, Vec3::Zero(), frames[t].angles, pose);
    frames[t].positions = stacked_ends(pose);
  }
  return frames;
}

}  // namespace sparse_mocap::path_regression
