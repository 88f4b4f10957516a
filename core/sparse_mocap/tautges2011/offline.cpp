// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/offline.hpp"

#include <algorithm>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

std::vector<std::int32_t> backwards(std::vector<std::int32_t> values) {
  std::reverse(values.begin(), values.end());
  return values;
}

// Angles, root position and yaw as one column a frame; angles are unwound so that neighbouring
// frames can be averaged.
Eigen::MatrixXd pose_columns(const std::vector<PoseEstimate>& estimates) {
  const Eigen::Index angles = estimates.front().angles.size();
  Eigen::MatrixXd columns(angles + 4, static_cast<Eigen::Index>(estimates.size()));
  for (Eigen::Index t = 0; t < columns.cols(); ++t) {
    const PoseEstimate& estimate = estimates[static_cast<std::size_t>(t)];
    columns.col(t) << estimate.angles, estimate.root_position, estimate.yaw_rad;
    if (t == 0) continue;
    auto now = columns.col(t).head(angles).array();
    now -= 2.0 * kPi * ((now - columns.col(t - 1).head(angles).array()) / (2.0 * kPi)).round();
  }
  return columns;
}

}  // namespace

TwoWayRetrieval::TwoWayRetrieval(const std::vector<std::int32_t>& clip_of_frame,
                                 const OlngConfig& config)
    : forward_(clip_of_frame, config),
      backward_(backwards(clip_of_frame), config),
      last_frame_(static_cast<int>(clip_of_frame.size()) - 1),
      config_(config) {}

void TwoWayRetrieval::run(std::span<const std::vector<Neighbour>> columns) {
  paths_.assign(columns.size(), {});
  forward_.reset();
  for (std::size_t t = 0; t < columns.size(); ++t) {
    forward_.extend(columns[t]);
    paths_[t] = forward_.paths();
  }
  backward_.reset();
  std::vector<Neighbour> mirrored;
  for (std::size_t t = columns.size(); t-- > 0;) {
    mirrored = columns[t];
    for (auto& neighbour : mirrored) neighbour.row = last_frame_ - neighbour.row;
    backward_.extend(mirrored);
    const double charge =
        mirrored.empty() ? 0.0 : config_.penalty * static_cast<double>(mirrored.back().distance);
    for (std::size_t i = 0; i < mirrored.size(); ++i) {
      // Both directions count the node itself.
      const double own = charge - static_cast<double>(mirrored[i].distance);
      paths_[t][i].reward += backward_.paths()[i].reward - own;
      paths_[t][i].length += backward_.paths()[i].length - 1;
    }
  }
}

std::vector<PoseEstimate> smoothed_take(const std::vector<PoseEstimate>& estimates,
                                        const MotionDatabase& database, const Config& config) {
  if (estimates.empty() || config.offline_smoothing_s <= 0.0) return estimates;
  std::vector<double> times_s;
  for (std::size_t t = 0; t < estimates.size(); ++t)
    times_s.push_back(static_cast<double>(t) * database.frame_time_s());
  const Eigen::MatrixXd smooth = filtered_at(times_s, pose_columns(estimates), times_s,
                                             GaussianFilter{config.offline_smoothing_s});
  std::vector<PoseEstimate> out = estimates;
  JointTransforms pose;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const auto column = smooth.col(static_cast<Eigen::Index>(t));
    const Eigen::Index angles = out[t].angles.size();
    out[t].angles = column.head(angles);
    out[t].root_position = column.segment<3>(angles);
    out[t].yaw_rad = column[angles + 3];
    forward_kinematics(database.skeleton(), Vec3::Zero(), out[t].angles, pose);
    for (std::size_t j = 0; j < pose.end.size(); ++j)
      out[t].positions.segment<3>(3 * static_cast<Eigen::Index>(j)) = pose.end[j];
  }
  return out;
}

}  // namespace sparse_mocap::tautges2011
