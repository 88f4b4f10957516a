// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/recent_points.hpp"

#include <utility>

#include "sparse_mocap/path_regression/frame_target.hpp"

namespace sparse_mocap::path_regression {

void RecentPoints::begin(std::uint64_t user, const MotionDatabase& database, double lever_m,
                         std::size_t most_frames) {
  std::swap(now_, before_);
  if (user != user_) before_.num_known = 0;
  now_.num_known = 0;
  next_before_ = 0;
  user_ = user;
  database_ = &database;
  lever_m_ = lever_m;
  for (Reading* reading : {&now_, &before_})
    while (reading->frames.size() < most_frames)
      reading->frames.emplace_back().points.resize(12 * database.skeleton().num_joints());
}

const Eigen::VectorXd& RecentPoints::of(int frame) {
  Kept& kept = now_.frames[now_.num_known++];
  kept.frame = frame;
  while (next_before_ < before_.num_known && before_.frames[next_before_].frame < frame)
    ++next_before_;
  if (next_before_ < before_.num_known && before_.frames[next_before_].frame == frame) {
    std::swap(kept.points, before_.frames[next_before_++].points);
    return kept.points;
  }
  angles_ = database_->angles().row(frame).transpose().cast<double>();
  forward_kinematics(database_->skeleton(), Vec3::Zero(), angles_, pose_);
  put_pose_points(pose_, lever_m_, kept.points);
  return kept.points;
}

}  // namespace sparse_mocap::path_regression
